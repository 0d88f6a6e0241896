#include "io/text/number_text.h"

#include <array>
#include <charconv>

namespace reeb::io {

void append_double(std::string& out, double value) { append_rounded(out, value, 17); }

void append_rounded(std::string& out, double value, int digits) {
  std::array<char, 40> text;
  const auto result =
      std::to_chars(text.data(), text.data() + text.size(), value + 0.0, std::chars_format::general, digits);
  out.append(text.data(), result.ptr);
}

void append_shortest(std::string& out, double value) {
  std::array<char, 40> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value + 0.0);
  out.append(text.data(), result.ptr);
}

}  // namespace reeb::io
