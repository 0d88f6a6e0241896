// The stars of a chunk's vertices, by rank: in which triangles a vertex is the lowest, middle or highest corner.
//
// Triangles are renumbered such that those with the same lowest vertex are consecutive; for middle and highest vertices
// there are lists (CSR). An edge is stored as a triangle with mid == hi and is in no middle list. A loose vertex is in
// no list.
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
    std::uint32_t place;        // its index in the chunk, which is in stream order
  };

  // O(vertices + triangles). `order[r]` is the local vertex of rank r.
  void build(const Chunk& chunk, std::span<const std::uint32_t> order);

  std::size_t triangle_count() const { return triangles_.size(); }
  const Triangle& operator[](std::uint32_t t) const { return triangles_[t]; }
  // The triangles in which rank v is lowest: low_first(v), ... low_last(v) - 1.
  std::uint32_t low_first(std::uint32_t v) const { return ends_[v].low; }
  std::uint32_t low_last(std::uint32_t v) const { return ends_[v + 1].low; }
  std::span<const std::uint32_t> middles(std::uint32_t v) const {
    return {lists_.data() + ends_[v].high, ends_[v + 1].mid - ends_[v].high};
  }
  // The triangles in which rank v is not lowest: the middles first.
  std::span<const std::uint32_t> middles_and_highs(std::uint32_t v) const {
    return {lists_.data() + ends_[v].high, ends_[v + 1].high - ends_[v].high};
  }
  // The place of the last triangle that uses rank v; 0 if there is none.
  std::uint32_t last_place(std::uint32_t v) const;

  std::size_t memory_bytes() const {
    return triangles_.capacity() * sizeof(Triangle) + ends_.capacity() * sizeof(Ends) +
           4 * (rank_.capacity() + lists_.capacity());
  }

 private:
  // Where the triangles of a vertex end: those in which it is lowest, among the triangles; those in which it is middle,
  // then those in which it is highest, in the lists.
  struct Ends {
    std::uint32_t low, mid, high;
  };

  void count(const Chunk& chunk);
  void fill(const Chunk& chunk);

  std::vector<std::uint32_t> rank_;  // of each local vertex
  std::vector<Triangle> triangles_;
  std::vector<Ends> ends_;  // those of rank v are at v + 1; entry 0 is zeros
  std::vector<std::uint32_t> lists_;
};

}  // namespace reeb
