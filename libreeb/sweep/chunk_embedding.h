// The embedding of a chunk: the regular vertices of each arc in buckets (docs/SEMANTICS.md, Buckets).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/containers/id_vector.h"
#include "libreeb/sweep/arc_slots.h"
#include "libreeb/sweep/sweep_graph.h"
#include "libreeb/sweep/wide_sums.h"

namespace reeb {

class ChunkEmbedding {
 public:
  // Adds each vertex of an arc to its bucket; arcs[v] is the arc of vertex v, or none(). O(vertices).
  // REQUIRES: the values of vertices are between those of the ends of their arcs; no bucket was made in the graph since
  // BucketLists::start().
  void run(SweepGraph& graph, const SweptChunk& swept, const IdVector<LocalVertex, SweepArc>& arcs, int exponent);
  std::size_t memory_bytes() const;

 private:
  // The buckets of one index: those up to `end`, from that of the slab before.
  struct Slab {
    std::int64_t index;
    std::uint32_t end;
  };

  bool place_slots(const SweepGraph& graph, const SweptChunk& swept, const BucketIndexer& indexer);
  bool fill_slots(SweepGraph& graph, const SweptChunk& swept, const IdVector<LocalVertex, SweepArc>& arcs,
                  const BucketIndexer& indexer);
  void find_buckets(const SweptChunk& swept, const IdVector<LocalVertex, SweepArc>& arcs, std::size_t arc_count,
                    int exponent);
  void fill_buckets(SweepGraph& graph, const SweptChunk& swept);

  std::vector<std::uint32_t> bucket_of_;  // by local vertex: its bucket, or its slot
  // Where buckets have many vertices:
  std::int64_t first_index_ = 0;  // of the chunk
  std::vector<ArcSlots> slots_;   // by arc; the last ones are of vertices without an arc
  std::vector<WideSum> wide_sums_;
  // Where they have few:
  std::vector<Slab> slabs_;
  std::vector<SweepArc> arc_of_;        // by bucket
  std::vector<std::uint32_t> last_of_;  // by arc: one more than its last bucket
};

}  // namespace reeb
