// Divides the graph of a sweep into a fragment's open nodes and arcs, which the rest of the mesh can still change, and
// its settled ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/value_range.h"
#include "libreeb/sweep/fragment.h"
#include "libreeb/sweep/sweep_graph.h"
#include "libreeb/sweep/sweep_options.h"

namespace reeb {

// The value of a node, and how far monotone paths from it lead.
struct NodeReach {
  double value;
  ValueRange range;
};

class FragmentDivision {
 public:
  // Adds the nodes and arcs of `graph` to `fragment`, and moves their embedding there. Sets `open` of the nodes and
  // arcs of the graph. REQUIRES: `referenced` is set for the arcs on paths.
  void run(SweepGraph& graph, const SweptChunk& swept, const SweepOptions& options, Fragment& fragment);
  std::size_t memory_bytes() const {
    return reaches_.capacity() * sizeof(NodeReach) +
           4 * (node_at_.capacity() + open_arcs_.capacity() + arc_at_.capacity() + arcs_from_.capacity());
  }

 private:
  void divide_arcs(SweepGraph& graph, bool embeds, Fragment& fragment);
  void add_nodes(SweepGraph& graph, const SweptChunk& swept, Fragment& fragment);
  void add_arcs(SweepGraph& graph, Fragment& fragment);
  void add_buckets(SweepGraph& graph, Fragment& fragment);

  IdVector<SweepNode, NodeReach> reaches_;  // if there can be noise
  std::vector<SweepArc> open_arcs_;
  IdVector<LocalVertex, SweepNode> node_at_;  // none() if it is no open node
  IdVector<FragmentArc, SweepArc> arc_at_;
  std::vector<std::uint32_t> arcs_from_;  // by open node: the next number for its arcs up
};

}  // namespace reeb
