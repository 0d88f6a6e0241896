// Port: where settled nodes and arcs go (docs/ARCHITECTURE.md, A triangle's way through).
#pragma once

#include <span>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/settled_node.h"

namespace reeb {

// Arcs of the final graph, with their embedding if there is one.
struct SettledArcs {
  std::span<const ArcKeys> arcs;
  ArcListsView lists = {};
  int bucket_exponent = 0;  // of all these buckets; a later call may have a larger one
};

// Receives every node and every arc of the final graph exactly once, in no particular order.
// The spans are valid during the call only.
//
// THREADS: called by one thread at a time, not always the same.
class GraphSink {
 public:
  GraphSink() = default;
  GraphSink(const GraphSink&) = delete;
  GraphSink& operator=(const GraphSink&) = delete;
  virtual ~GraphSink() = default;

  virtual void add_nodes(std::span<const SettledNode> nodes) = 0;
  virtual void add_arcs(const SettledArcs& settled) = 0;
};

}  // namespace reeb
