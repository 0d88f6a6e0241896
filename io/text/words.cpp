#include "io/text/words.h"

namespace reeb::io {

std::string quoted(std::string_view word) {
  constexpr std::size_t kShown = 40;
  std::string text = "\"";
  text.append(word.substr(0, kShown));
  return text.append(word.size() > kShown ? "...\"" : "\"");
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
