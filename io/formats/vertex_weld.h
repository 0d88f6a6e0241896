// Numbers points by first appearance; equal points get the same number.
//
// MEMORY: 24 bytes per distinct point, and 16 to 32 bytes for its hash table entry. STL does not store which corners
// are shared, so only a table of all points finds them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace reeb::io {

class VertexWeld {
 public:
  using Coordinates = std::array<double, 3>;

  // The number of the point, and whether it is new. REQUIRES: no NaN and no -0.0.
  std::pair<std::uint64_t, bool> number(const Coordinates& point) {
    if (2 * points_.size() >= table_.size()) grow();
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash(point) & mask;
    for (; table_[slot] != 0; slot = (slot + 1) & mask)
      if (points_[table_[slot] - 1] == point) return {table_[slot] - 1, false};
    points_.push_back(point);
    table_[slot] = points_.size();
    return {points_.size() - 1, true};
  }

  std::uint64_t memory_bytes() const {
    return points_.capacity() * sizeof(Coordinates) + table_.capacity() * sizeof(std::uint64_t);
  }

 private:
  static std::size_t hash(const Coordinates& point) {
    std::uint64_t state = 0;
    for (const double coordinate : point) {
      state = (state ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15u;
      state ^= state >> 32;
    }
    return static_cast<std::size_t>(state);
  }

  void grow() {
    const std::size_t size = table_.empty() ? 1024 : 2 * table_.size();
    table_.assign(size, 0);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      std::size_t slot = hash(points_[i]) & (size - 1);
      while (table_[slot] != 0) slot = (slot + 1) & (size - 1);
      table_[slot] = i + 1;
    }
  }

  std::vector<Coordinates> points_;
  std::vector<std::uint64_t> table_;  // number + 1, 0 is free; a power of two of slots
};

}  // namespace reeb::io
