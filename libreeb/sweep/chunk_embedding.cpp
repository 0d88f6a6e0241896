#include "libreeb/sweep/chunk_embedding.h"

#include <algorithm>
#include <span>

#include "libreeb/sweep/avx2.h"

namespace reeb {

void ChunkEmbedding::run(SweepGraph& graph, const SweptChunk& swept, const IdVector<LocalVertex, SweepArc>& arcs,
                         int exponent) {
  if (bucket_of_.capacity() < arcs.size()) clear_with_room(bucket_of_, arcs.size());
  bucket_of_.resize(arcs.size());
  const BucketIndexer indexer(exponent);
  if (place_slots(graph, swept, indexer) && fill_slots(graph, swept, arcs, indexer)) return;
  find_buckets(swept, arcs, graph.arcs.size(), exponent);
  fill_buckets(graph, swept);
}

// Gives each arc a slot for each index from that of its lower end to that of its upper end. False if that is not
// possible (there are no positions, no AVX2, too many vertices, or indices too far apart), or does not pay: slots have
// less than eight vertices each.
bool ChunkEmbedding::place_slots(const SweepGraph& graph, const SweptChunk& swept, const BucketIndexer& indexer) {
  constexpr std::int64_t kVerticesPerSlot = 8, kMostIndices = std::int64_t{1} << 30;
  const auto n = static_cast<std::uint32_t>(swept.order.size());
  if (n == 0 || n > kMostWideVertices || swept.chunk.positions.empty()) return false;
  if (indexer.scale() == 0 || !has_avx2()) return false;
  first_index_ = indexer(swept.value(VertexRank(0)));
  if (indexer(swept.value(VertexRank(n - 1))) - first_index_ >= kMostIndices) return false;
  clear_with_room(slots_, graph.arcs.size() + 1);
  std::int64_t end = 0;
  for (const SweepGraph::Arc& arc : graph.arcs) {
    const std::int64_t lowest = indexer(graph.nodes[arc.lo].key.value),
                       highest = indexer(graph.nodes[arc.hi].key.value);
    const std::int64_t from = end - (lowest - first_index_);
    end += highest - lowest + 1;
    if (kVerticesPerSlot * end > n) return false;
    slots_.push_back({static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(end)});
  }
  slots_.push_back({kNoSlot, 0});
  return end != 0;
}

// False if some vertices are too far from the origin.
bool ChunkEmbedding::fill_slots(SweepGraph& graph, const SweptChunk& swept, const IdVector<LocalVertex, SweepArc>& arcs,
                                const BucketIndexer& indexer) {
  const std::uint32_t count = slots_[slots_.size() - 2].end;
  const auto& positions = swept.chunk.positions;
  find_slots(swept.values, arcs, slots_, indexer, first_index_, bucket_of_);
  fill_with_room(wide_sums_, count + 1, WideSum());
  if (add_wide(wide_sums_, bucket_of_, positions) < positions.size()) return false;

  const std::span<BucketSum> sums = graph.buckets.make(count);
  std::uint32_t s = 0;
  for (SweepArc a; a < graph.arcs.end_id(); ++a)
    for (const ArcSlots slots = slots_[a.value()]; s < slots.end; ++s) {
      if (wide_sums_[s].count == 0) {
        graph.buckets.drop(s);
        continue;
      }
      sums[s] = wide_sums_[s].to_bucket();
      sums[s].index = first_index_ + static_cast<std::uint32_t>(s - slots.from);
      graph.buckets.link(graph.arc_buckets[a], s);
    }
  return true;
}

// In the order of the sweep, all vertices of one index follow each other. Whether a vertex has an arc cannot be
// predicted, so it takes no branch: vertices without one have an arc of their own, which always has a last bucket.
void ChunkEmbedding::find_buckets(const SweptChunk& swept, const IdVector<LocalVertex, SweepArc>& arcs,
                                  std::size_t arc_count, int exponent) {
  const auto n = static_cast<std::uint32_t>(arcs.size()), no_arc = static_cast<std::uint32_t>(arc_count);
  slabs_.clear();
  if (arc_of_.capacity() < n) clear_with_room(arc_of_, n);
  arc_of_.resize(n);
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
      const std::uint32_t local = order[r];
      std::uint32_t& last = last_of[std::min(arc[local].value(), no_arc)];
      if (last <= first) {
        arc_of[count] = arc[local];
        last = ++count;
      }
      bucket_of[local] = last - 1;
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
void ChunkEmbedding::fill_buckets(SweepGraph& graph, const SweptChunk& swept) {
  const std::uint32_t count = slabs_.empty() ? 0 : slabs_.back().end;
  const std::span<BucketSum> sums = graph.buckets.make(count);
  std::ranges::fill(sums, BucketSum());
  const auto& positions = swept.chunk.positions;
  const Point origin{};
  for (std::size_t i = 0; i < bucket_of_.size(); ++i)
    if (bucket_of_[i] < count) sums[bucket_of_[i]].add(positions.empty() ? origin : positions[i]);
  std::uint32_t b = 0;
  for (const Slab& slab : slabs_)
    for (; b < slab.end; ++b) {
      sums[b].index = slab.index;
      graph.buckets.link(graph.arc_buckets[arc_of_[b]], b);
    }
}

std::size_t ChunkEmbedding::memory_bytes() const {
  return slabs_.capacity() * sizeof(Slab) + slots_.capacity() * sizeof(ArcSlots) +
         wide_sums_.capacity() * sizeof(WideSum) +
         4 * (bucket_of_.capacity() + arc_of_.capacity() + last_of_.capacity());
}

}  // namespace reeb
