#include "libreeb/sweep/chunk_stars.h"

#include <algorithm>
#include <utility>

namespace reeb {
namespace {

// Ranks of a triangle's corners; lo == hi for a loose vertex, mid == hi for an edge.
struct SortedCorners {
  SortedCorners(const std::uint32_t* rank, const std::uint32_t* corners) {
    const std::uint32_t a = rank[corners[0]], b = rank[corners[1]], c = rank[corners[2]];
    const std::uint32_t less = least(a, b), greater = a + b - less;
    lo = least(less, c);
    const std::uint32_t not_least = less + c - lo;
    const std::uint32_t rest = least(greater, not_least);
    hi = greater + not_least - rest;
    mid = rest == lo ? hi : rest;
  }
  std::uint32_t lo, mid, hi;

 private:
  // Without a branch, since it could not be predicted; compilers make one of std::min. Ranks are less than 2^31.
  static std::uint32_t least(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t difference = a - b;
    return b + (difference & (0 - (difference >> 31)));
  }
};

}  // namespace

void ChunkStars::build(const Chunk& chunk, std::span<const std::uint32_t> order) {
  rank_.resize(chunk.vertex_count());
  for (std::uint32_t r = 0; r < order.size(); ++r) rank_[order[r]] = r;
  count(chunk);
  fill(chunk);
}

// Sets ends_[v + 1] to where the triangles and lists of v begin; fill() then advances it to where they end.
void ChunkStars::count(const Chunk& chunk) {
  fill_with_room(ends_, chunk.vertex_count() + 1, Ends{0, 0, 0});
  Ends* const counts = ends_.data() + 1;
  const std::uint32_t* const rank = rank_.data();
  const std::uint32_t* corners = chunk.corners.data();
  for (std::size_t left = chunk.triangle_count(); left > 0; --left, corners += 3) {
    const SortedCorners t(rank, corners);
    if (t.lo == t.hi) continue;
    ++counts[t.lo].low;
    counts[t.mid].mid += t.mid != t.hi;
    ++counts[t.hi].high;
  }
  std::uint32_t triangles = 0, listed = 0;
  for (Ends& begin : ends_) {
    triangles += std::exchange(begin.low, triangles);
    listed += std::exchange(begin.mid, listed);
    listed += std::exchange(begin.high, listed);
  }
  stored_.resize(triangles);
  lists_.resize(listed);
}

void ChunkStars::fill(const Chunk& chunk) {
  Ends* const next = ends_.data() + 1;
  Stored* const stored = stored_.data();
  std::uint32_t* const lists = lists_.data();
  const std::uint32_t* const rank = rank_.data();
  const std::uint32_t* corners = chunk.corners.data();
  const auto places = static_cast<std::uint32_t>(chunk.triangle_count());
  for (std::uint32_t place = 0; place < places; ++place, corners += 3) {
    const SortedCorners sorted(rank, corners);
    if (sorted.lo == sorted.hi) continue;
    const std::uint32_t t = next[sorted.lo].low++;
    stored[t] = {std::uint64_t{sorted.hi} << 32 | sorted.mid, sorted.lo, place};
    if (sorted.mid != sorted.hi) lists[next[sorted.mid].mid++] = t;
    lists[next[sorted.hi].high++] = t;
  }
}

std::uint32_t ChunkStars::last_place(std::uint32_t v) const {
  std::uint32_t last = 0;
  for (std::uint32_t t = low_first(v); t < low_last(v); ++t) last = std::max(last, stored_[t].place);
  for (const std::uint32_t t : middles_and_highs(v)) last = std::max(last, stored_[t].place);
  return last;
}

}  // namespace reeb
