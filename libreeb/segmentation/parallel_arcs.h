// The order of parallel arcs: what tells them apart are their vertices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// Parallel arcs are ordered by the smallest index of a vertex that lies on them. Arcs without vertices come last, in
// the order of the graph; nothing tells them apart. Call see() for all vertices on arcs, then order().
//
// MEMORY: kArcBytes per arc, if there are parallel arcs; 4 of them are the result.
class ParallelArcs {
 public:
  static constexpr std::uint64_t kArcBytes = 12;

  // REQUIRES: `graph` outlives this.
  explicit ParallelArcs(const ReebGraph& graph) : graph_(graph) {
    for (std::size_t a = 1; a < graph.arc_count() && first_vertex_.empty(); ++a)
      if (same_ends(a - 1, a)) first_vertex_.assign(graph.arc_count(), kNone);
  }

  bool any() const { return !first_vertex_.empty(); }
  // REQUIRES: any().
  void see(ArcId arc, std::uint64_t vertex) {
    std::uint64_t& first = first_vertex_[arc.value()];
    first = std::min(first, vertex);
  }
  // By arc: its new position in the graph.
  std::vector<ArcId> order() const;

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  bool same_ends(std::size_t a, std::size_t b) const {
    return graph_.lo[a] == graph_.lo[b] && graph_.hi[a] == graph_.hi[b];
  }

  const ReebGraph& graph_;
  std::vector<std::uint64_t> first_vertex_;  // by arc; empty if no arcs are parallel
};

}  // namespace reeb
