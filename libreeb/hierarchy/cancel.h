// All levels of detail of a Reeb graph at once (docs/SEMANTICS.md, Cancelling and Levels).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "libreeb/base/work.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/packed_lists.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/deferred_changes.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/port/record_sink.h"
#include "libreeb/port/ring_turns.h"

namespace reeb {

// The most memory that build_hierarchy() holds, including the graph and its buckets. With an embedding, `lists` is its
// PackedLists::memory_bytes(). Only buckets that are cut over and over could exceed it, or a loop of millions of arcs.
std::uint64_t hierarchy_bytes(std::uint64_t nodes, std::uint64_t arcs, std::optional<std::uint64_t> lists);

// How build_hierarchy() works; the result does not depend on it.
struct HierarchyWork {
  Poll poll = {};
  DoBoth both = {};
  RingTurns* turns = nullptr;          // with it, two threads cancel: `both` must run its functions at the same time
  std::optional<RunAhead> ahead = {};  // nothing: RunAhead::for_arcs()
  // With an embedding, nodes and arcs that are left move together in memory when 1 / shrink^2 of the pairs is left, and
  // each time that 1 / shrink of these is. REQUIRES: it is not 0.
  std::size_t shrink = 4;
};

// Pairs the nodes, and cancels all pairs but Ext0 in the order of cancelling. The arc records, with the versions in
// which each lives, go to `sink`; Hierarchy::arcs and dropped stay empty. The ends of a record never change, and an arc
// that a step does not change keeps its record. Afterwards `graph` has only its nodes and positions.
//
// `buckets` are an embedding of the graph's arcs, of this exponent, or empty. Pairs and the graph of every version are
// the same with an embedding and without. An arc to which a step adds vertices gets a new record. So in every version
//
//   vertices in buckets + nodes + vertices dropped in this version or before
//
// is the same as in version 0.
//
// TIME:   O(m log m) for the pairs. A cancellation costs its two paths and a search. The search costs no more than the
//         smaller of two parts of the graph within the pair's interval: that above the lower node, and that below the
//         upper node.
// MEMORY: hierarchy_bytes(), unless `ahead` is more than the default.
// THREADS: `poll` and `sink` are called in this thread. The other one, if there is one, does a sweep, makes the working
//          graph, and follows the rules of cancelling, which run `ahead` of the buckets and records.
// REQUIRES: no node is of degree (1, 1).
Hierarchy build_hierarchy(ReebGraph& graph, PackedLists buckets, int exponent, RecordSink& sink,
                          const HierarchyWork& work = {});

}  // namespace reeb
