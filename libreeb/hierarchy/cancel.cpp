#include "libreeb/hierarchy/cancel.h"

#include "libreeb/hierarchy/canceller.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"

namespace reeb {

Hierarchy build_hierarchy(ReebGraph graph) {
  Hierarchy hierarchy;
  hierarchy.pairs = persistence_pairs(graph);
  hierarchy.isolated = isolated_nodes(graph);
  Canceller<> canceller(graph);
  // The canceller has the arcs now; only the values of nodes are still needed.
  graph.lo = std::vector<NodeId>();
  graph.hi = std::vector<NodeId>();
  graph.positions = std::vector<std::array<double, 3>>();
  for (PersistencePair& pair : hierarchy.pairs) {
    if (pair.type == PairType::kExt0) break;
    pair.kept = !canceller.cancel(pair);
    if (!pair.kept) hierarchy.persistence.push_back(persistence_of(graph, pair));
  }
  hierarchy.arcs = canceller.take_records();
  return hierarchy;
}

}  // namespace reeb
