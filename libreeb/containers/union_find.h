// Disjoint sets of 0..n-1 in one flat array: path halving, linking by index.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "libreeb/base/prefetch.h"

namespace reeb {

// The smaller index always becomes the root, so a set is named by its least element, and the result does not depend on
// the order of unions. Amortized O(log n) per call.
class UnionFind {
 public:
  explicit UnionFind(std::uint32_t size = 0) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }

  void prefetch(std::uint32_t x) const { reeb::prefetch(&parent_[x]); }
  // Whether x is the least element of its set.
  bool is_least(std::uint32_t x) const { return parent_[x] == x; }

  // True if x and y were in different sets.
  bool unite(std::uint32_t x, std::uint32_t y) {
    x = find(x);
    y = find(y);
    if (x == y) return false;
    parent_[std::max(x, y)] = std::min(x, y);
    return true;
  }

  std::uint32_t add() {
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    return parent_.back();
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(parent_.size()); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace reeb
