// Keeps a graph in memory as it leaves the engine.
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"

namespace reeb::ooc {

class GraphCollector : public GraphSink {
 public:
  void add_nodes(std::span<const SettledNode> nodes) override {
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
  }
  void add_arcs(std::span<const ArcKeys> arcs) override { arcs_.insert(arcs_.end(), arcs.begin(), arcs.end()); }

  // Moves the graph out.
  ReebGraph take();

 private:
  std::vector<SettledNode> nodes_;
  std::vector<ArcKeys> arcs_;
};

}  // namespace reeb::ooc
