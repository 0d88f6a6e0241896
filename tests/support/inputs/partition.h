// Disjoint sets in their plainest form, for the models and generators of the tests.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace reeb::test {

class Partition {
 public:
  explicit Partition(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t find(std::size_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  // The smaller representative stays.
  void unite(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    parent_[a > b ? a : b] = a > b ? b : a;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace reeb::test
