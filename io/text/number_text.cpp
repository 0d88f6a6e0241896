#include "io/text/number_text.h"

namespace reeb::io {

void append_double(std::string& out, double value) { append_rounded(out, value, 17); }

void append_rounded(std::string& out, double value, int digits) {
  std::array<char, 40> text;
  const auto result =
      std::to_chars(text.data(), text.data() + text.size(), value + 0.0, std::chars_format::general, digits);
  out.append(text.data(), result.ptr);
}

std::string short_number(double value, int digits) {
  std::string text;
  append_rounded(text, value, digits);
  return text;
}

void append_shortest(std::string& out, double value) {
  std::array<char, 40> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value + 0.0);
  out.append(text.data(), result.ptr);
}

void append_field(std::string& out, float value) {
  std::array<char, 40> text;
  text[0] = ' ';
  const auto result = std::to_chars(text.data() + 1, text.data() + text.size(), static_cast<double>(value),
                                    std::chars_format::general, 9);
  out.append(text.data(), result.ptr);
}

void append_field(std::string& out, double value) {
  std::array<char, 40> text;
  text[0] = ' ';
  const auto result = std::to_chars(text.data() + 1, text.data() + text.size(), value);
  out.append(text.data(), result.ptr);
}

}  // namespace reeb::io
