// Words of a text, as readers compare and show them.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace reeb::io {

// The word as messages show it: its first 40 characters, in quotes. It is not `quoted`, since std::quoted would be
// found for strings, too.
std::string in_quotes(std::string_view word);
// The value of a hexadecimal digit, or -1.
int hex_digit(char c);
// The text with each %XX as the byte that these hexadecimal digits are.
struct PercentDecoded {
  std::string text;
  bool is_valid = true;  // else a '%' without digits stayed as it was
};
PercentDecoded percent_decoded(std::string_view text);

// The text without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

// Of the letters A to Z alone; other characters stay.
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);

// The integer that the whole word is, in decimal digits, with '-' for a signed type. Nothing if it does not fit.
template <class Integer>
std::optional<Integer> whole_number(std::string_view word) {
  Integer value = 0;
  const char* const end = word.data() + word.size();
  const auto parsed = std::from_chars(word.data(), end, value);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return value;
}

}  // namespace reeb::io
