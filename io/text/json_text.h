// Pieces of JSON.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "io/text/output_buffer.h"
#include "libreeb/base/printable.h"

namespace reeb::io {

// A string literal: control characters, quotes and backslashes are escaped, UTF-8 is unchanged. A byte that is not part
// of a UTF-8 character is not possible in JSON, so it is shown as \xff (libreeb/base/printable.h).
inline void write_json_string(std::string_view text, OutputBuffer& out) {
  constexpr std::string_view kHex = "0123456789abcdef";
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  out << '"';
  while (!text.empty()) {
    const auto beyond = static_cast<std::size_t>(std::ranges::find_if(text, is_ascii) - text.begin());
    for (const char c : printable(text.substr(0, beyond))) out << (c == '\\' ? "\\\\" : std::string_view(&c, 1));
    text.remove_prefix(beyond);
    if (text.empty()) break;
    const char c = text[0];
    if (c == '"' || c == '\\')
      out << '\\' << c;
    else if (c < 0x20)
      out << "\\u00" << kHex[static_cast<std::size_t>(c >> 4)] << kHex[static_cast<std::size_t>(c & 15)];
    else
      out << c;
    text.remove_prefix(1);
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
