#include "libreeb/engine/chunk_stars.h"

#include <algorithm>
#include <utility>

namespace reeb {
namespace {

// Turns counts at [v + 1] into begins at [v], leaving room to fill: after the fill loop, which
// advances begin[v + 1] for v, the array holds begins and the end.
void counts_to_fill_positions(std::vector<std::uint32_t>& begin) {
  std::uint32_t sum = 0;
  for (std::size_t v = 1; v < begin.size(); ++v) sum += std::exchange(begin[v], sum);
}

}  // namespace

void ChunkStars::build(const Chunk& chunk, std::span<const std::uint32_t> order) {
  const std::size_t n = chunk.vertex_count();
  rank.resize(n);
  for (std::uint32_t r = 0; r < n; ++r) rank[order[r]] = r;

  low_begin.assign(n + 1, 0);
  mid_begin.assign(n + 1, 0);
  high_begin.assign(n + 1, 0);
  sorted_corners_.clear();
  for (std::size_t t = 0; t < chunk.triangle_count(); ++t) {
    std::uint32_t a = rank[chunk.corners[3 * t]], b = rank[chunk.corners[3 * t + 1]],
                  c = rank[chunk.corners[3 * t + 2]];
    if (a > b) std::swap(a, b);
    if (b > c) std::swap(b, c);
    if (a > b) std::swap(a, b);
    if (a == c) continue;      // a loose vertex
    if (a == b) b = c;         // an edge
    ++low_begin[a + 1];
    if (b != c) ++mid_begin[b + 1];
    ++high_begin[c + 1];
    sorted_corners_.push_back({a, b, c, static_cast<std::uint32_t>(t)});
  }
  counts_to_fill_positions(low_begin);
  counts_to_fill_positions(mid_begin);
  counts_to_fill_positions(high_begin);

  const std::size_t m = sorted_corners_.size();
  lo.resize(m);
  mid.resize(m);
  hi.resize(m);
  place.resize(m);
  mid_list.resize(m);
  high_list.resize(m);
  for (const Corners& c : sorted_corners_) {
    const std::uint32_t t = low_begin[c.lo + 1]++;
    lo[t] = c.lo;
    mid[t] = c.mid;
    hi[t] = c.hi;
    place[t] = c.place;
    if (c.mid != c.hi) mid_list[mid_begin[c.mid + 1]++] = t;
    high_list[high_begin[c.hi + 1]++] = t;
  }
}

std::uint32_t ChunkStars::last_place(std::uint32_t v) const {
  std::uint32_t last = 0;
  for (std::uint32_t t = low_first(v); t < low_last(v); ++t) last = std::max(last, place[t]);
  for (const std::uint32_t t : middles(v)) last = std::max(last, place[t]);
  for (const std::uint32_t t : highs(v)) last = std::max(last, place[t]);
  return last;
}

}  // namespace reeb
