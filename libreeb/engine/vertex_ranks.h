// Sorts a chunk's vertices into the total order: ranks by (value, VertexId).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb {

// O(n) for distinct values: a radix sort on the bits of the values that skips the digits in which
// all values agree (values that were floats once leave half of them); ties are sorted by id.
class VertexRanks {
 public:
  // After it, order()[r] is the local vertex of rank r.
  // REQUIRES: no value is NaN or -0.0; ids are distinct; fewer than 2^32 vertices.
  void sort(std::span<const double> values, std::span<const VertexId> ids);

  std::span<const std::uint32_t> order() const { return order_; }
  std::size_t memory_bytes() const {
    return (entries_.capacity() + other_.capacity()) * sizeof(Entry) + order_.capacity() * 4;
  }

 private:
  struct Entry {
    std::uint64_t bits;
    std::uint32_t local;
  };
  std::vector<Entry> entries_, other_;
  std::vector<std::uint32_t> order_;
};

}  // namespace reeb
