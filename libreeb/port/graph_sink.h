// Port: where settled nodes and arcs go (docs/ARCHITECTURE.md, A triangle's way through).
#pragma once

#include <cstdint>
#include <span>

#include "libreeb/graph/bucket.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/settled_node.h"

namespace reeb {

// Arcs of the final graph, with their embedding if there is one: arc i owns the next
// bucket_counts[i] of `buckets`, ascending.
struct SettledArcs {
  std::span<const ArcKeys> arcs;
  std::span<const std::uint32_t> bucket_counts = {};  // one per arc; empty: no embedding
  std::span<const Bucket> buckets = {};
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
