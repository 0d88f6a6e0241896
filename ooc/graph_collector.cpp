#include "ooc/graph_collector.h"

#include <algorithm>
#include <utility>

namespace reeb::ooc {

ReebGraph GraphCollector::take() {
  std::sort(nodes_.begin(), nodes_.end(),
            [](const SettledNode& a, const SettledNode& b) { return a.key < b.key; });
  std::vector<SweepKey> keys;
  keys.reserve(nodes_.size());
  for (const SettledNode& node : nodes_) keys.push_back(node.key);
  ReebGraph graph = make_graph(std::exchange(arcs_, {}), std::move(keys));
  graph.positions.reserve(nodes_.size());
  for (const SettledNode& node : nodes_) graph.positions.push_back(node.position);
  nodes_ = {};
  return graph;
}

}  // namespace reeb::ooc
