// Numbers as the text formats print them (docs/CLI.md, `reeb extract FILE`).
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <string>

namespace reeb::io {

// `%.17g` in the C locale, -0 as 0: restores every double exactly.
void append_double(std::string& out, double value);
// As few digits as restore the double, -0 as 0.
void append_shortest(std::string& out, double value);
// This many significant digits at most, -0 as 0.
void append_rounded(std::string& out, double value, int digits);
// The same for people, who need few: "0.25", "1.5e+20".
std::string short_number(double value, int digits = 6);

// How many digits tell numbers of this range apart as well as `digits` do where the range is as large as the numbers.
int digits_for_range(double low, double high, int digits = 6);

// A blank and a number, as in the lines of streaming meshes; -0 stays. A float as `%.9g`, which restores it; a double
// in the shortest form that restores it.
void append_field(std::string& out, float value);
void append_field(std::string& out, double value);
template <std::integral Integer>
void append_field(std::string& out, Integer value) {
  std::array<char, 24> text;
  text[0] = ' ';
  out.append(text.data(), std::to_chars(text.data() + 1, text.data() + text.size(), value).ptr);
}

}  // namespace reeb::io
