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

// All pairs, in the order of cancelling, Ext0 last. Exact: the total order decides everything; persistences only sort
// the result. As a multiset the result does not depend on the order of arcs.
//
// TIME:   O(m log m), in expectation for the loops (see BottleneckForest).
// THREADS: any number of calls at the same time.
// MEMORY: 4 bytes per arc, 20 bytes per node and 36 bytes per pair (12 of them the result).
std::vector<PersistencePair> persistence_pairs(const ReebGraph& graph, const Poll& poll = {});

// A pair with what it is sorted by first.
struct RankedPair {
  double persistence;
  PersistencePair pair;
};

// The same in two parts. The upward sweep takes longer than the downward one, whose thread then sorts what it found.
//
// MEMORY: without the result, 4 bytes per arc and 20 bytes per node; with it, up to 36 bytes per pair.
// THREADS: `poll` is called in this one.
struct SweptPairs {
  std::vector<PersistencePair> rising, components;  // Ord0 and Ext1, Ext0
  std::vector<RankedPair> falling;                  // Rel1, in the order of cancelling
};
SweptPairs swept_pairs(const ReebGraph& graph, const Poll& poll, const DoBoth& both);
// MEMORY: 36 bytes per pair, 12 of them the result.
std::vector<PersistencePair> sorted_pairs(const ReebGraph& graph, SweptPairs pairs);

// Sorts pairs into the order of cancelling: Ext0 after all others; then persistence ascending, hi
// ascending, lo descending, Ext1 before Ord0 before Rel1. So a pair inside another's interval always comes before it.
void sort_for_cancelling(const ReebGraph& graph, std::vector<PersistencePair>& pairs);

}  // namespace reeb
