// Pieces of JSON.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "io/text/output_buffer.h"

namespace reeb::io {

// A string literal: control characters, quotes and backslashes are escaped, UTF-8 is unchanged.
inline void write_json_string(std::string_view text, OutputBuffer& out) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out << '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out << '\\' << c;
    else if (byte < 0x20)
      out << "\\u00" << kHex[byte >> 4] << kHex[byte & 15];
    else
      out << c;
  }
  out << '"';
}

// JSON has no infinities.
inline void write_json_number(double value, OutputBuffer& out) {
  if (std::isfinite(value))
    out << Shortest{value};
  else
    out << "null";
}

inline void write_json_point(const std::array<double, 3>& point, OutputBuffer& out) {
  out << '[' << Shortest{point[0]} << ", " << Shortest{point[1]} << ", " << Shortest{point[2]} << ']';
}

}  // namespace reeb::io
