// All levels of detail of a Reeb graph at once (docs/SEMANTICS.md, Cancelling and Levels).
#pragma once

#include <cstdint>
#include <optional>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/packed_lists.h"
#include "libreeb/port/record_sink.h"

namespace reeb {

// What build_hierarchy() holds at most, the graph and its buckets included: of an embedding, `lists` is what
// PackedLists::memory_bytes() says of it. Only buckets that are cut again and again could make it more.
std::uint64_t hierarchy_bytes(std::uint64_t nodes, std::uint64_t arcs, std::optional<std::uint64_t> lists);

// Pairs the nodes, cancels all pairs but Ext0 in the order of persistence, and tells when each arc
// lives: its records go to `sink`, and Hierarchy::arcs and dropped stay empty. A record's arc has the
// same ends throughout, and arcs that a step leaves as they were keep their record. Of the graph only
// nodes and positions are left.
//
// `buckets` are an embedding of the graph's arcs, of this exponent; or there are none. Pairs and the
// graph of every version are the same with it and without. An arc to which a step adds vertices gets a
// record of its own; so in every version
//
//   vertices in buckets + nodes + vertices dropped in this version or before
//
// is what it was in version 0.
//
// TIME:   O(m log m) for the pairs; a cancellation costs its two paths and a search that goes no
//         further than the lesser of what lies above the lower and below the upper node within
//         the pair's interval.
// MEMORY: hierarchy_bytes().
// REQUIRES: no node is of degree (1, 1).
Hierarchy build_hierarchy(ReebGraph& graph, PackedLists buckets, int exponent, RecordSink& sink, const Poll& poll = {});

}  // namespace reeb
