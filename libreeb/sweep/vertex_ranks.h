// Sorts a chunk's vertices into the total order: ranks by (value, VertexId).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb {

// A counting pass distributes n vertices over n buckets of equal width; a bucket is sorted by comparison if it is not
// in order already. O(n) if values are distributed about evenly, and for ties in order of id; O(n log n) at worst.
class VertexRanks {
 public:
  // Afterwards order()[r] is the local vertex of rank r.
  // REQUIRES: no value is NaN or infinite; ids are distinct; fewer than 2^31 vertices.
  void sort(std::span<const double> values, std::span<const VertexId> ids);

  std::span<const std::uint32_t> order() const { return order_; }
  std::size_t memory_bytes() const { return (order_.capacity() + bucket_end_.capacity()) * 4; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> bucket_end_;
};

}  // namespace reeb
