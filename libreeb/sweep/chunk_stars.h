// The stars of a chunk's vertices, by rank: in which triangles a vertex is the lowest, middle or highest corner.
//
// Triangles are renumbered such that those with the same lowest vertex are consecutive; for middle and highest vertices
// there are lists (CSR). An edge is stored as a triangle with mid == hi and is in no middle list. A loose vertex is in
// no list.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/sweep/chunk.h"

namespace reeb {

class ChunkStars {
 public:
  struct Triangle {
    std::uint32_t lo, mid, hi;  // ranks
    std::uint32_t place;        // its index in the chunk, which is in stream order
  };

  // O(vertices + triangles). `order[r]` is the local vertex of rank r.
  void build(const Chunk& chunk, std::span<const std::uint32_t> order);

  std::size_t triangle_count() const { return stored_.size(); }
  Triangle operator[](std::uint32_t t) const { return {stored_[t].lo, mid(t), hi(t), stored_[t].place}; }
  std::uint32_t mid(std::uint32_t t) const { return static_cast<std::uint32_t>(stored_[t].upper); }
  std::uint32_t hi(std::uint32_t t) const { return static_cast<std::uint32_t>(stored_[t].upper >> 32); }
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
  // True if the triangles in which rank v is lowest are 1 to 3, those in which it is middle 1 or 2, and the former
  // connect all edges up from v. With `manifold`, also only if no edge up from v has a third triangle; there may be
  // none where it is false. Decided without branches, since they could not be predicted.
  bool is_small_and_connected_above(std::uint32_t v, bool manifold) const;
  // The place of the last triangle that uses rank v; 0 if there is none.
  std::uint32_t last_place(std::uint32_t v) const;

  std::size_t memory_bytes() const {
    return stored_.capacity() * sizeof(Stored) + ends_.capacity() * sizeof(Ends) +
           4 * (rank_.capacity() + lists_.capacity());
  }

 private:
  // Where the triangles of a vertex end: those in which it is lowest, among the triangles; those in which it is middle,
  // then those in which it is highest, in the lists.
  struct Ends {
    std::uint32_t low, mid, high;
  };

  // A triangle; its upper edge is hi << 32 | mid, as is_small_and_connected_above() reads it.
  struct Stored {
    std::uint64_t upper;
    std::uint32_t lo, place;
  };

  void count(const Chunk& chunk);
  void fill(const Chunk& chunk);

  std::vector<std::uint32_t> rank_;  // of each local vertex
  std::vector<Stored> stored_;
  std::vector<Ends> ends_;  // those of rank v are at v + 1; entry 0 is zeros
  std::vector<std::uint32_t> lists_;
};

inline bool ChunkStars::is_small_and_connected_above(std::uint32_t v, bool manifold) const {
  constexpr std::uint64_t kOnes = 0x0000000100000001, kTops = 0x8000000080000000;
  // Its top bits are not all 0 iff one half of `pair` is 0. Ranks are less than 2^31.
  const auto zero_half = [](std::uint64_t pair) { return (pair - kOnes) & kTops; };
  const auto swapped = [](std::uint64_t pair) { return pair << 32 | pair >> 32; };
  const Ends &begin = ends_[v], &end = ends_[v + 1];
  const std::uint32_t lows = end.low - begin.low, middles = end.mid - begin.high;
  if (lows - 1 >= 3 || middles - 1 >= 2) return false;
  // The upper edges of the former triangles, and the upper ends of the latter. If there are fewer, some occur twice.
  const Stored* const low = stored_.data() + begin.low;
  const std::uint64_t a = low[0].upper, b = low[lows >= 2 ? 1 : 0].upper, c = low[lows - 1].upper;
  const std::uint32_t* const list = lists_.data() + begin.high;
  const std::uint64_t x = kOnes * hi(list[0]), y = kOnes * hi(list[middles - 1]);
  const auto meet = [&](std::uint64_t e, std::uint64_t f) {
    const std::uint64_t met = zero_half(e ^ f) | zero_half(e ^ swapped(f));
    return met | met << 32;
  };
  const std::uint64_t ab = meet(a, b), ac = meet(a, c), bc = meet(b, c);
  const std::uint64_t lows_connected = (ab & ac) | (ab & bc) | (ac & bc);
  if (manifold) {
    // The path of the former triangles neither closes nor branches, and each of the latter meets one of them, at
    // another end.
    const std::uint64_t is_second = 0 - std::uint64_t{lows >= 2}, is_third = 0 - std::uint64_t{lows == 3};
    const auto hits = [&](std::uint64_t other) {
      return int{zero_half(a ^ other) != 0} + int{(zero_half(b ^ other) & is_second) != 0} +
             int{(zero_half(c ^ other) & is_third) != 0};
    };
    const bool closed = (ab & ac & bc & is_third) != 0, together = x == y && middles == 2;
    if (closed || together || hits(x) > 1 || hits(y) > 1) return false;
  }
  const std::uint64_t x_met = zero_half(a ^ x) | zero_half(b ^ x) | zero_half(c ^ x);
  const std::uint64_t y_met = zero_half(a ^ y) | zero_half(b ^ y) | zero_half(c ^ y);
  return (static_cast<int>(lows_connected >> 63) & static_cast<int>(x_met != 0) & static_cast<int>(y_met != 0)) != 0;
}

}  // namespace reeb
