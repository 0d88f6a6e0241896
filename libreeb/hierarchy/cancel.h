// All levels of detail of a Reeb graph at once (DESIGN.md 1.5, 6).
#pragma once

#include <functional>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/arc_buckets.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb {

// Called now and then while a hierarchy is built; it may throw to end that.
using Poll = std::function<void()>;

// Pairs the nodes, cancels all pairs but Ext0 in the order of persistence, and records when each
// arc lives. Hierarchy::arcs is sorted by died, so that all records alive at some version or later
// are a suffix; a record's arc has the same ends throughout, and arcs that a step leaves as they
// were keep their record.
//
// TIME:   O(m log m) for the pairs; a cancellation costs its two paths and a search that goes no
//         further than the lesser of what lies above the lower and below the upper node within
//         the pair's interval.
// MEMORY: while cancelling, 40 bytes an arc, 32 a node, 12 a pair and 16 a record; together with
//         growth at most 160 bytes an arc where nodes have three arcs or one.
// REQUIRES: no node is of degree (1, 1).
Hierarchy build_hierarchy(ReebGraph graph, const Poll& poll = {});

// The same with an embedding: `buckets`, of the graph's arcs, becomes that of Hierarchy::arcs. Pairs
// and the graph of every version are the same. An arc to which a step adds vertices gets a record
// of its own; so in every version
//
//   vertices in buckets + nodes + vertices dropped in this version or before
//
// is what it was in version 0. With empty `buckets` there is no embedding.
//
// MEMORY: besides, 48 bytes a bucket of the largest version, 40 a bucket of all records, 8 an arc and
//         8 a record.
// REQUIRES: all buckets are of this exponent.
Hierarchy build_hierarchy(ReebGraph graph, ArcBuckets& buckets, int exponent, const Poll& poll = {});

}  // namespace reeb
