// Noise removal on a graph in memory: the exact final pass (DESIGN.md 1.6).
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb {

struct Denoised {
  ReebGraph graph;
  // The pairs that are gone, Ord0 and Rel1 only, by the nodes of the graph that was given, in the
  // order of cancelling. All others are as before.
  std::vector<PersistencePair> removed;
};

// Repeats, until nothing changes: remove a leaf (an extremum with one arc) of persistence <
// threshold whose saddle has another monotone path, in the leaf's direction, that reaches beyond
// the leaf in the total order; then (1, 1) nodes disappear. The result does not depend on any order
// of steps.
//
// TIME:   O(m log m), for sorting the result only.
// MEMORY: 8 bytes an arc and 28 a node; 36 a removed pair (12 of them the result).
// REQUIRES: no node is of degree (1, 1).
Denoised denoise(const ReebGraph& graph, double threshold);

}  // namespace reeb
