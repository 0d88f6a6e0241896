// Disjoint sets of more elements than memory holds.
#pragma once

#include <algorithm>
#include <cstdint>

#include "ooc/tables/paged_table.h"

namespace reeb::ooc {

// Elements are numbered from 0 without an upper limit; each is a set of its own at first. As in UnionFind: path
// halving, and linking to the smaller index, so the name of a set is its smallest element.
//
// THROWS, MEMORY, THREADS: as PagedTable, with 8 bytes per element that was ever in a union.
class PagedUnionFind {
 public:
  PagedUnionFind(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes)
      : links_(owner, temp, budget, allowance_bytes, 0) {}

  std::uint64_t find(std::uint64_t x) {
    for (std::uint64_t above; (above = parent(x)) != x;) {
      const std::uint64_t next = parent(above);
      if (next != above) set_parent(x, next);
      x = next;
    }
    return x;
  }

  // True if x and y were in different sets.
  bool unite(std::uint64_t x, std::uint64_t y) {
    x = find(x);
    y = find(y);
    if (x == y) return false;
    set_parent(std::max(x, y), std::min(x, y));
    ++unions_;
    return true;
  }

  // The number of successful unions; n elements form n minus this many sets.
  std::uint64_t unions() const { return unions_; }

 private:
  // A link is the parent xor the element itself, so that a fresh entry is its own root.
  std::uint64_t parent(std::uint64_t x) { return links_.get(x) ^ x; }
  void set_parent(std::uint64_t x, std::uint64_t parent) { links_.set(x, parent ^ x); }

  PagedTable<std::uint64_t> links_;
  std::uint64_t unions_ = 0;
};

}  // namespace reeb::ooc
