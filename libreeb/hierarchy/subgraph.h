// A graph made of arcs between some of the nodes of another.
#pragma once

#include <span>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// Ends of an arc, as nodes of the full graph.
struct NodeArc {
  NodeId lo, hi;
  friend auto operator<=>(const NodeArc&, const NodeArc&) = default;
};

// The graph of these arcs (in any order), their ends, and isolated nodes (ascending). Keys and positions are copied.
// O(k log k) for a result of size k, whatever the size of `full`.
ReebGraph subgraph(const ReebGraph& full, std::vector<NodeArc> arcs, std::span<const NodeId> isolated);

// The nodes without arcs, ascending.
std::vector<NodeId> isolated_nodes(const ReebGraph& graph);

}  // namespace reeb
