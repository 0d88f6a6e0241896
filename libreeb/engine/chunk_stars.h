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

struct ChunkStars {
  std::vector<std::uint32_t> rank;           // of each local vertex
  std::vector<std::uint32_t> lo, mid, hi;    // ranks, one a triangle
  std::vector<std::uint32_t> place;          // of each triangle in the chunk's stream
  std::vector<std::uint32_t> low_begin, mid_begin, high_begin;  // one a rank, plus the end
  std::vector<std::uint32_t> mid_list, high_list;

  // O(vertices + triangles). `order[r]` is the local vertex of rank r.
  void build(const Chunk& chunk, std::span<const std::uint32_t> order);

  std::size_t triangle_count() const { return lo.size(); }
  std::uint32_t low_first(std::uint32_t v) const { return low_begin[v]; }
  std::uint32_t low_last(std::uint32_t v) const { return low_begin[v + 1]; }
  std::span<const std::uint32_t> middles(std::uint32_t v) const {
    return {mid_list.data() + mid_begin[v], mid_begin[v + 1] - mid_begin[v]};
  }
  std::span<const std::uint32_t> highs(std::uint32_t v) const {
    return {high_list.data() + high_begin[v], high_begin[v + 1] - high_begin[v]};
  }
  // The last place in the stream at which rank v is used; 0 if nowhere.
  std::uint32_t last_place(std::uint32_t v) const;

  std::size_t memory_bytes() const {
    return sorted_corners_.capacity() * sizeof(Corners) +
           4 * (rank.capacity() + lo.capacity() * 6 + low_begin.capacity() * 3);
  }

 private:
  struct Corners {
    std::uint32_t lo, mid, hi, place;
  };
  std::vector<Corners> sorted_corners_;
};

}  // namespace reeb
