#include "libreeb/base/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace reeb {
namespace {

// Of insertions, deletions and changes of a letter.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& names) {
  const auto best =
      std::ranges::min_element(names, {}, [&](const std::string& name) { return edit_distance(word, name); });
  if (best == names.end()) return {};
  const std::size_t dashes = std::min(word.find_first_not_of('-'), word.size());
  const std::size_t letters = std::max(word.size(), best->size()) - dashes;
  // About half of the letters must agree.
  return 2 * edit_distance(word, *best) <= letters + 1 ? *best : std::string();
}

}  // namespace reeb
