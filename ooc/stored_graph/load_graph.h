// From a finished store to a graph in memory.
#pragma once

#include <cstdint>
#include <optional>

#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/packed_lists.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

// A graph in memory with its reservation.
struct LoadedGraph {
  Reservation memory;
  ReebGraph graph;
  PackedLists buckets;  // empty unless wanted
};

struct LoadOptions {
  bool positions = true;
  std::optional<int> bucket_exponent = {};  // set: read buckets, coarsened to this
};

// Nodes and arcs are numbered in 32 bits, and one number stands for none.
// THROWS: Error{kResource} about `file` if there are more.
void require_numbers(std::uint64_t nodes, std::uint64_t arcs, const std::string& file,
                     const std::string& hint = "remove noise with --denoise, or more of it");

// The most that read_graph() reserves.
std::uint64_t loading_bytes(const SegmentStore& store, const LoadOptions& options);

// Reads all of a finished store, for a second stage in memory.
//
// THROWS: Error{kResource} if the graph does not fit the budget, before anything is read;
//         BrokenGraph if an arc ends in no node.
LoadedGraph read_graph(SegmentStore& store, const LoadOptions& options = {}, const Poll& poll = {});

}  // namespace reeb::ooc
