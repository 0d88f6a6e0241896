#include "io/text/number_text.h"

#include <algorithm>
#include <cmath>

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

int digits_for_range(double low, double high, int digits) {
  constexpr int kAll = 17;
  const double most = std::max(std::abs(low), std::abs(high)) / 2, range = high / 2 - low / 2;  // halves are finite
  if (!(range > 0) || range >= most) return digits;
  return std::min(kAll, digits + static_cast<int>(std::log10(most / range)));
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
