// Sets of vertices or triangles of a patch, by number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "libreeb/containers/flat_map.h"

namespace reeb {

// Vertices or triangles of a patch.
using PatchNumbers = std::vector<std::uint32_t>;

// Sorts them, each once.
inline void make_set(PatchNumbers& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

// A set that keeps the order in which numbers were added. O(1) for each step.
class NumberSet {
 public:
  bool has(std::uint32_t x) const { return place_.find(x) != FlatMap::kNone; }
  bool add(std::uint32_t x) {
    const auto place = static_cast<std::uint32_t>(list_.size());
    if (place_.find_or_insert(x, place) != place) return false;
    list_.push_back(x);
    return true;
  }
  const PatchNumbers& list() const { return list_; }

 private:
  FlatMap place_;
  PatchNumbers list_;
};

}  // namespace reeb
