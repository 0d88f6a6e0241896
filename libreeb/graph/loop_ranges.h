// The smallest loop through each arc of a Reeb graph (docs/SEMANTICS.md, Loops of arcs).
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// The loop range of an arc that is on no cycle.
inline constexpr double kNoLoop = -1;

// For each arc the least range of values, highest minus lowest node, of a cycle through it, or kNoLoop. Ranges of
// cycles are persistences of loops (Ext1 pairs). One beyond the doubles counts as the greatest of them.
//
// TIME:    O((nodes + arcs) log(nodes)), amortized.
// MEMORY:  48 bytes per node and arc, besides the result.
// THREADS: any number of calls at the same time.
std::vector<double> loop_ranges(const ReebGraph& graph);

}  // namespace reeb
