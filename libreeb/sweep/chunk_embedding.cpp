#include "libreeb/sweep/chunk_embedding.h"

#include <algorithm>

namespace reeb {

void ChunkEmbedding::run(SweepGraph& graph, const SweptChunk& swept, const IdVector<VertexRank, SweepArc>& arcs,
                         int exponent) {
  find_buckets(swept, arcs, graph.arcs.size(), exponent);
  const std::span<BucketSum> sums = graph.buckets.make(slabs_.empty() ? 0 : slabs_.back().end);
  add_positions(sums, swept.chunk.positions);
  std::uint32_t b = 0;
  for (const Slab& slab : slabs_)
    for (; b < slab.end; ++b) {
      sums[b].index = slab.index;
      graph.buckets.link(graph.arc_buckets[arc_of_[b]], b);
    }
}

// In the order of the sweep, all vertices of one index follow each other. Whether a vertex has an arc cannot be
// predicted, so it takes no branch: vertices without one have an arc of their own, which always has a last bucket.
void ChunkEmbedding::find_buckets(const SweptChunk& swept, const IdVector<VertexRank, SweepArc>& arcs,
                                  std::size_t arc_count, int exponent) {
  const auto n = static_cast<std::uint32_t>(arcs.size()), no_arc = static_cast<std::uint32_t>(arc_count);
  slabs_.clear();
  if (arc_of_.capacity() < n) clear_with_room(arc_of_, n);
  arc_of_.resize(n);
  if (bucket_of_.capacity() < n) clear_with_room(bucket_of_, n);
  bucket_of_.resize(n);
  fill_with_room(last_of_, arc_count + 1, 0u);
  last_of_[no_arc] = ~std::uint32_t{0};
  // Locals stay in registers: no write can change them.
  SweepArc* const arc_of = arc_of_.data();
  std::uint32_t *const bucket_of = bucket_of_.data(), *const last_of = last_of_.data();
  const std::uint32_t* const order = swept.order.data();
  const auto arc = arcs.begin();
  std::uint32_t count = 0, first = 0;  // first: of the current index
  for (std::uint32_t v = 0, end = n; v < n; v = end) {
    const std::int64_t index = bucket_index(swept.value(VertexRank(v)), exponent);
    end = swept.end_of_bucket(v, index, exponent);
    // An index comes again if its end cannot be a double.
    if (slabs_.empty() || slabs_.back().index != index) first = count;
    for (std::uint32_t r = v; r < end; ++r) {
      std::uint32_t& last = last_of[std::min(arc[r].value(), no_arc)];
      if (last <= first) {
        arc_of[count] = arc[r];
        last = ++count;
      }
      bucket_of[order[r]] = last - 1;
    }
    if (count == first) continue;
    if (!slabs_.empty() && slabs_.back().index == index)
      slabs_.back().end = count;
    else
      slabs_.push_back({index, count});
  }
}

// In the order of the chunk: there positions follow each other in memory, and vertices next to each other on the mesh
// are often of one bucket.
void ChunkEmbedding::add_positions(std::span<BucketSum> sums, std::span<const Point> positions) {
  constexpr std::size_t kVerticesPerWideSum = 8;  // with fewer, wide sums do not pay
  if (sums.empty()) return;
  std::size_t first = 0;
  if (positions.size() >= kVerticesPerWideSum * sums.size() && can_add_wide()) {
    fill_with_room(wide_sums_, sums.size() + 1, WideSum());
    first = add_wide(wide_sums_, bucket_of_, positions);
    for (std::size_t b = 0; b < sums.size(); ++b) sums[b] = wide_sums_[b].to_bucket();
  } else {
    std::fill(sums.begin(), sums.end(), BucketSum());
  }
  const Point origin{};
  for (std::size_t i = first; i < bucket_of_.size(); ++i)
    if (bucket_of_[i] < sums.size()) sums[bucket_of_[i]].add(positions.empty() ? origin : positions[i]);
}

std::size_t ChunkEmbedding::memory_bytes() const {
  return slabs_.capacity() * sizeof(Slab) + 4 * (arc_of_.capacity() + bucket_of_.capacity() + last_of_.capacity()) +
         wide_sums_.capacity() * sizeof(WideSum);
}

}  // namespace reeb
