#include "io/text/words.h"

namespace reeb::io {

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kShown = 40;
  std::string text = "\"";
  text.append(word.substr(0, kShown));
  return text.append(word.size() > kShown ? "...\"" : "\"");
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

PercentDecoded percent_decoded(std::string_view text) {
  PercentDecoded decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escape = text[i] == '%' && i + 2 < text.size();
    const int high = is_escape ? hex_digit(text[i + 1]) : -1, low = is_escape ? hex_digit(text[i + 2]) : -1;
    if (high >= 0 && low >= 0) {
      decoded.text += static_cast<char>(high * 16 + low);
      i += 2;
      continue;
    }
    if (text[i] == '%') decoded.is_valid = false;
    decoded.text += text[i];
  }
  return decoded;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

}  // namespace reeb::io
