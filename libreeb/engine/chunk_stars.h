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
  std::uint32_t low_first(std::uint32_t v) const { return ends_[v].low; }
  std::uint32_t low_last(std::uint32_t v) const { return ends_[v + 1].low; }
  std::span<const std::uint32_t> middles(std::uint32_t v) const {
    return {lists_.data() + ends_[v].high, ends_[v + 1].mid - ends_[v].high};
  }
  // Those in which rank v is not lowest: the middles first.
  std::span<const std::uint32_t> middles_and_highs(std::uint32_t v) const {
    return {lists_.data() + ends_[v].high, ends_[v + 1].high - ends_[v].high};
  }
  // The last place in the stream at which rank v is used; 0 if nowhere.
  std::uint32_t last_place(std::uint32_t v) const;

  std::size_t memory_bytes() const {
    return triangles_.capacity() * sizeof(Triangle) + ends_.capacity() * sizeof(Ends) +
           4 * (rank_.capacity() + lists_.capacity());
  }

 private:
  // Where those end in which a vertex is lowest (among the triangles), and in which it is middle and
  // then highest (in the lists).
  struct Ends {
    std::uint32_t low, mid, high;
  };

  void count(const Chunk& chunk);
  void fill(const Chunk& chunk);

  std::vector<std::uint32_t> rank_;  // of each local vertex
  std::vector<Triangle> triangles_;
  std::vector<Ends> ends_;  // of rank v at v + 1, before it zeros
  std::vector<std::uint32_t> lists_;
};

}  // namespace reeb
