// The result of the second stage: persistence pairs, and all levels of detail at once
// (docs/SEMANTICS.md, Pairs and Levels; the paper's "Simplification and Hierarchy").
//
// The sequence of simplified graphs is partially persistent: an arc is a record with the steps
// between which it lives. Cancellation number s (from 1) turns version s-1 into version s; version
// 0 is the full graph. The graph of version e has the arcs with born <= e < died.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/arc_version.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// In the order in which equal persistences are listed in files.
enum class PairType : std::uint8_t { kExt0, kExt1, kOrd0, kRel1 };

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
  // By died, descending: every prefix up to some `died` is all that lives then. Then by (lo, hi, born).
  std::vector<ArcVersion> arcs;
  // A node without arcs in a version is present in it only as an isolated point:
  // isolated[i] is the node; present in every version, since Ext0 is never cancelled.
  std::vector<NodeId> isolated;
  // By version, ascending; empty without an embedding.
  std::vector<DroppedVertices> dropped;
};

// Called now and then while a hierarchy is built; it may throw to end that.
using Poll = std::function<void()>;

// Pairs the nodes and cancels all pairs but Ext0 in the order of persistence.
//
// TIME:    O(m log m) for the pairs; a cancellation costs its two paths and a search that stays within the
//          pair's interval.
// MEMORY:  about 115 bytes an arc; of the result, 16 a record.
// THREADS: any number of calls at the same time.
// REQUIRES: no node is of degree (1, 1). (What OnlineReeb and ReebFile give has none.)
Hierarchy build_hierarchy(ReebGraph graph, const Poll& poll = {});

// The same with an embedding, of this exponent: `buckets` becomes that of Hierarchy::arcs, 40 bytes a
// bucket of all records. With empty `buckets` there is no embedding. Pairs and graphs are the same with it
// and without.
Hierarchy build_hierarchy(ReebGraph graph, ArcBuckets& buckets, int exponent, const Poll& poll = {});

}  // namespace reeb
