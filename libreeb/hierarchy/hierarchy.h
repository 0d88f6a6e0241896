// The result of the second stage: persistence pairs, and all levels of detail at once
// (docs/SEMANTICS.md, Pairs and Levels; the paper's "Simplification and Hierarchy").
//
// All versions of the graph are stored together: an arc is a record with the versions between which it lives. Version 0
// is the full graph; cancellation s (from 1) turns version s - 1 into version s. The graph of version e has the arcs
// with born <= e < died.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/arc_version.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// The order is that in which files list pairs of equal persistence.
enum class PairType : std::uint8_t { kExt0, kExt1, kOrd0, kRel1 };
constexpr const char* name_of(PairType type) {
  constexpr const char* kNames[] = {"Ext0", "Ext1", "Ord0", "Rel1"};
  return kNames[static_cast<std::size_t>(type)];
}

struct PersistencePair {
  NodeId lo, hi;  // nodes of the full graph; equal for an isolated vertex (Ext0)
  PairType type = PairType::kExt0;
  bool kept = false;  // an Ext1 that no rule could cancel
  friend bool operator==(const PersistencePair&, const PersistencePair&) = default;
};

struct Hierarchy {
  // All pairs, in the order of cancelling (docs/SEMANTICS.md, Cancelling); Ext0 last.
  std::vector<PersistencePair> pairs;
  // persistence[s - 1] is that of the pair cancelled by step s; not decreasing.
  std::vector<double> persistence;
  // By died, descending, then by (lo, hi, born). So the arcs that live longer than a given version are a prefix.
  std::vector<ArcVersion> arcs;
  // The nodes without arcs, which are isolated points. Each is in every version, since Ext0 is never cancelled. (Any
  // other node is in the versions in which it has arcs.)
  std::vector<NodeId> isolated;
  // By version, ascending; empty without an embedding.
  std::vector<DroppedVertices> dropped;
};

// Called from time to time with the part of the work that is done, from 0 to 1. It may throw to stop the work.
using Poll = std::function<void(double done)>;

// Pairs the nodes, and cancels all pairs but Ext0 in the order of cancelling.
//
// TIME:    O(m log m) for the pairs; a cancellation costs its two paths and a search that stays within the
//          pair's interval.
// MEMORY:  142 bytes per arc where there are as many nodes; for the result, 16 per record.
// THREADS: any number of calls at the same time.
// REQUIRES: no node is of degree (1, 1). (Graphs from OnlineReeb and ReebFile have none.)
Hierarchy build_hierarchy(ReebGraph graph, const Poll& poll = {});

// The same with an embedding, of this exponent: `buckets` becomes that of Hierarchy::arcs, sizeof(Bucket) bytes per
// bucket of all records. With empty `buckets` there is no embedding. Pairs and graphs are the same with an embedding
// and without.
Hierarchy build_hierarchy(ReebGraph graph, ArcBuckets& buckets, int exponent, const Poll& poll = {});

}  // namespace reeb
