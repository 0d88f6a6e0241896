// The stars of a chunk's vertices in rank space: who is lowest, middle and highest where.
//
// Triangles are renumbered so that those with the same lowest vertex are consecutive; for middle
// and highest vertices there are lists (CSR). An edge is kept as a triangle with mid == hi and is
// in no middle list; a loose vertex is in no list at all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/engine/chunk.h"

namespace reeb {

class ChunkStars {
 public:
  struct Triangle {
    std::uint32_t lo, mid, hi;  // ranks
    std::uint32_t place;        // in the chunk's stream
  };

  // O(vertices + triangles). `order[r]` is the local vertex of rank r.
  void build(const Chunk& chunk, std::span<const std::uint32_t> order);

  std::size_t triangle_count() const { return triangles_.size(); }
  const Triangle& operator[](std::uint32_t t) const { return triangles_[t]; }
  // The triangles in which rank v is lowest: low_first(v), ... low_last(v) - 1.
  std::uint32_t low_first(std::uint32_t v) const { return begins_[v].low; }
  std::uint32_t low_last(std::uint32_t v) const { return begins_[v + 1].low; }
  std::span<const std::uint32_t> middles(std::uint32_t v) const {
    return {mid_list_.data() + begins_[v].mid, begins_[v + 1].mid - begins_[v].mid};
  }
  std::span<const std::uint32_t> highs(std::uint32_t v) const {
    return {high_list_.data() + begins_[v].high, begins_[v + 1].high - begins_[v].high};
  }
  // The last place in the stream at which rank v is used; 0 if nowhere.
  std::uint32_t last_place(std::uint32_t v) const;

  std::size_t memory_bytes() const {
    return triangles_.capacity() * sizeof(Triangle) + begins_.capacity() * sizeof(Begins) +
           4 * (rank_.capacity() + mid_list_.capacity() + high_list_.capacity());
  }

 private:
  struct Begins {
    std::uint32_t low, mid, high;
  };

  Triangle sorted(const Chunk& chunk, std::uint32_t place) const;
  void count(const Chunk& chunk);

  std::vector<std::uint32_t> rank_;  // of each local vertex
  std::vector<Triangle> triangles_;
  std::vector<Begins> begins_;  // one a rank, plus the end
  std::vector<std::uint32_t> mid_list_, high_list_;
};

}  // namespace reeb
