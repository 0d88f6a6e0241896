#include "libreeb/base/count_text.h"

namespace reeb {

std::string with_commas(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, 1, ',');
  return digits;
}

std::string count_of(std::uint64_t count, std::string_view noun) {
  std::string text = with_commas(count) + ' ';
  if (count == 1) return text.append(noun);
  if (noun.ends_with("ex")) return text.append(noun.substr(0, noun.size() - 2)).append("ices");
  if (noun.ends_with("is")) return text.append(noun.substr(0, noun.size() - 2)).append("es");
  if (noun.ends_with("ry")) return text.append(noun.substr(0, noun.size() - 1)).append("ies");
  return text.append(noun).append("s");
}

}  // namespace reeb
