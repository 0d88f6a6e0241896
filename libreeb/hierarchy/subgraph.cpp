#include "libreeb/hierarchy/subgraph.h"

#include <algorithm>

namespace reeb {

ReebGraph subgraph(const ReebGraph& full, std::vector<NodeArc> arcs, std::span<const NodeId> isolated) {
  std::vector<NodeId> nodes(isolated.begin(), isolated.end());
  nodes.reserve(nodes.size() + 2 * arcs.size());
  for (const NodeArc& arc : arcs) {
    nodes.push_back(arc.lo);
    nodes.push_back(arc.hi);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto rank = [&nodes](NodeId node) {
    const auto it = std::lower_bound(nodes.begin(), nodes.end(), node);
    return NodeId(static_cast<std::uint32_t>(it - nodes.begin()));
  };

  ReebGraph graph;
  graph.nodes.reserve(nodes.size());
  for (const NodeId node : nodes) graph.nodes.push_back(full.nodes[node.value()]);
  if (!full.positions.empty()) {
    graph.positions.reserve(nodes.size());
    for (const NodeId node : nodes) graph.positions.push_back(full.positions[node.value()]);
  }
  std::sort(arcs.begin(), arcs.end());
  graph.lo.reserve(arcs.size());
  graph.hi.reserve(arcs.size());
  for (const NodeArc& arc : arcs) {
    graph.lo.push_back(rank(arc.lo));
    graph.hi.push_back(rank(arc.hi));
  }
  return graph;
}

std::vector<NodeId> isolated_nodes(const ReebGraph& graph) {
  std::vector<bool> joined(graph.node_count());
  for (const NodeId node : graph.lo) joined[node.value()] = true;
  for (const NodeId node : graph.hi) joined[node.value()] = true;
  std::vector<NodeId> isolated;
  for (std::uint32_t node = 0; node < graph.node_count(); ++node)
    if (!joined[node]) isolated.emplace_back(node);
  return isolated;
}

}  // namespace reeb
