#include "libreeb/hierarchy/cancel.h"

#include "libreeb/hierarchy/canceller.h"
#include "libreeb/hierarchy/pairing.h"

namespace reeb {
namespace {

std::vector<NodeId> isolated_nodes(const ReebGraph& graph) {
  std::vector<bool> joined(graph.node_count());
  for (const NodeId node : graph.lo) joined[node.value()] = true;
  for (const NodeId node : graph.hi) joined[node.value()] = true;
  std::vector<NodeId> isolated;
  for (std::uint32_t node = 0; node < graph.node_count(); ++node)
    if (!joined[node]) isolated.emplace_back(node);
  return isolated;
}

}  // namespace

Hierarchy build_hierarchy(ReebGraph graph) {
  Hierarchy hierarchy;
  hierarchy.pairs = persistence_pairs(graph);
  hierarchy.isolated = isolated_nodes(graph);
  Canceller<> canceller(graph);
  graph.lo = {};  // the canceller has the arcs now
  graph.hi = {};
  graph.positions = {};
  for (PersistencePair& pair : hierarchy.pairs) {
    if (pair.type == PairType::kExt0) break;
    pair.kept = !canceller.cancel(pair);
    if (!pair.kept) hierarchy.persistence.push_back(persistence_of(graph, pair));
  }
  hierarchy.arcs = canceller.take_records();
  return hierarchy;
}

}  // namespace reeb
