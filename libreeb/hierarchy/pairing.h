// Extended persistence pairs of a Reeb graph (docs/SEMANTICS.md, Pairs; Agarwal, Edelsbrunner, Harer, Wang
// 2004).
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb {

// f(hi) - f(lo).
inline double persistence_of(const ReebGraph& graph, const PersistencePair& pair) {
  return graph.nodes[pair.hi.value()].value - graph.nodes[pair.lo.value()].value;
}

// All pairs, in the order of cancelling: Ext0 after all others; then persistence ascending, hi ascending, lo
// descending, Ext1 before Ord0 before Rel1. So a pair inside another's interval always comes before it. Exact: the
// total order decides everything; persistences only sort the result. As a multiset the result does not depend on the
// order of arcs.
//
// TIME:   O(m log m), in expectation for the loops (see BottleneckForest).
// THREADS: any number of calls at the same time.
// MEMORY: 4 bytes per arc, 20 bytes per node and 36 bytes per pair (12 of them the result).
std::vector<PersistencePair> persistence_pairs(const ReebGraph& graph, const Poll& poll = {});

}  // namespace reeb
