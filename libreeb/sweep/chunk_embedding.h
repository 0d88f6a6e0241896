// The embedding of a chunk: the regular vertices of each arc in buckets (docs/SEMANTICS.md, Buckets).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/containers/id_vector.h"
#include "libreeb/sweep/sweep_graph.h"
#include "libreeb/sweep/wide_sums.h"

namespace reeb {

class ChunkEmbedding {
 public:
  // Adds each vertex of an arc to its bucket; arcs[v] is the arc of vertex v, or none(). O(vertices).
  // REQUIRES: no bucket was made in the graph since BucketLists::start().
  void run(SweepGraph& graph, const SweptChunk& swept, const IdVector<VertexRank, SweepArc>& arcs, int exponent);
  std::size_t memory_bytes() const;

 private:
  // The buckets of one index: those up to `end`, from that of the slab before.
  struct Slab {
    std::int64_t index;
    std::uint32_t end;
  };

  void find_buckets(const SweptChunk& swept, const IdVector<VertexRank, SweepArc>& arcs, std::size_t arc_count,
                    int exponent);
  void add_positions(std::span<BucketSum> sums, std::span<const Point> positions);

  std::vector<Slab> slabs_;
  std::vector<SweepArc> arc_of_;          // by bucket
  std::vector<std::uint32_t> bucket_of_;  // by local vertex
  std::vector<std::uint32_t> last_of_;    // by arc: one more than its last bucket
  std::vector<WideSum> wide_sums_;
};

}  // namespace reeb
