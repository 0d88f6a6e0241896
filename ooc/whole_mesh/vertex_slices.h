// Slices of consecutive ids (or ranks) of vertices. A join by vertex partitions records by slice, and looks up each
// slice in memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace reeb::ooc {

class VertexSlices {
 public:
  // Slices have at most `most` entries, and fit the cache, unless there would be too many of them: each takes a buffer
  // while it is partitioned. The number of entries is a power of two, so that a look-up does not divide.
  VertexSlices(std::uint64_t vertices, std::uint64_t most) : vertices_(vertices), bits_(bits(vertices, most)) {}

  std::size_t count() const { return static_cast<std::size_t>((vertices_ + entries() - 1) >> bits_); }
  // Of each slice but the last one.
  std::uint64_t entries() const { return std::uint64_t{1} << bits_; }
  std::size_t size(std::size_t slice) const {
    return static_cast<std::size_t>(std::min(entries(), vertices_ - slice * entries()));
  }
  std::size_t slice_of(std::uint64_t id) const { return static_cast<std::size_t>(id >> bits_); }
  std::uint64_t place_of(std::uint64_t id) const { return id & (entries() - 1); }

 private:
  static constexpr std::uint64_t kInCache = 1u << 17, kLeast = 1u << 12, kManySlices = 64, kMostSlices = 1u << 16;

  static unsigned bits(std::uint64_t vertices, std::uint64_t most) {
    const std::uint64_t wanted = std::max(kInCache, vertices / kManySlices);
    const std::uint64_t least = std::max(kLeast, 2 * (vertices / kMostSlices));
    return static_cast<unsigned>(std::bit_width(std::min(wanted, std::max(least, most))) - 1);
  }

  std::uint64_t vertices_;
  unsigned bits_;
};

}  // namespace reeb::ooc
