#include "libreeb/engine/chunk_stars.h"

#include <algorithm>
#include <utility>

namespace reeb {

// The triangle at `place` by ranks; lo == hi for a loose vertex.
ChunkStars::Triangle ChunkStars::sorted(const Chunk& chunk, std::uint32_t place) const {
  const std::uint32_t* corners = &chunk.corners[3 * std::size_t{place}];
  const std::uint32_t a = rank_[corners[0]], b = rank_[corners[1]], c = rank_[corners[2]];
  // Without branches, since none could be foretold.
  const std::uint32_t lo = std::min(std::min(a, b), c), hi = std::max(std::max(a, b), c);
  const std::uint32_t mid = a ^ b ^ c ^ lo ^ hi;
  return {lo, mid == lo ? hi : mid, hi, place};
}

// Leaves begins_[v + 1] where the lists of v begin, so that filling them advances it to their end.
void ChunkStars::count(const Chunk& chunk) {
  begins_.assign(chunk.vertex_count() + 1, {0, 0, 0});
  const auto places = static_cast<std::uint32_t>(chunk.triangle_count());
  for (std::uint32_t place = 0; place < places; ++place) {
    const Triangle t = sorted(chunk, place);
    if (t.lo == t.hi) continue;
    ++begins_[t.lo + 1].low;
    begins_[t.mid + 1].mid += t.mid != t.hi;
    ++begins_[t.hi + 1].high;
  }
  Begins sum{0, 0, 0};
  for (Begins& begin : begins_) {
    sum.low += std::exchange(begin.low, sum.low);
    sum.mid += std::exchange(begin.mid, sum.mid);
    sum.high += std::exchange(begin.high, sum.high);
  }
  triangles_.resize(sum.low);
  mid_list_.resize(sum.mid);
  high_list_.resize(sum.high);
}

void ChunkStars::build(const Chunk& chunk, std::span<const std::uint32_t> order) {
  rank_.resize(chunk.vertex_count());
  for (std::uint32_t r = 0; r < order.size(); ++r) rank_[order[r]] = r;
  count(chunk);
  const auto places = static_cast<std::uint32_t>(chunk.triangle_count());
  for (std::uint32_t place = 0; place < places; ++place) {
    const Triangle triangle = sorted(chunk, place);
    if (triangle.lo == triangle.hi) continue;
    const std::uint32_t t = begins_[triangle.lo + 1].low++;
    triangles_[t] = triangle;
    if (triangle.mid != triangle.hi) mid_list_[begins_[triangle.mid + 1].mid++] = t;
    high_list_[begins_[triangle.hi + 1].high++] = t;
  }
}

std::uint32_t ChunkStars::last_place(std::uint32_t v) const {
  std::uint32_t last = 0;
  for (std::uint32_t t = low_first(v); t < low_last(v); ++t) last = std::max(last, triangles_[t].place);
  for (const std::uint32_t t : middles(v)) last = std::max(last, triangles_[t].place);
  for (const std::uint32_t t : highs(v)) last = std::max(last, triangles_[t].place);
  return last;
}

}  // namespace reeb
