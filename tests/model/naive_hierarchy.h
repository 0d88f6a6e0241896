// The hierarchy by copying and cancelling, as DESIGN.md 1.5 words it: the judge of the second
// stage.
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::test {

struct NaiveHierarchy {
  // In the order of cancelling, loops that are kept marked and in their turn; Ext0 last, in the
  // same order among themselves.
  std::vector<PersistencePair> pairs;
  // versions[s] is the graph after s cancellations, versions[0] the full graph. Keeping a loop is
  // no cancellation.
  std::vector<ReebGraph> versions;
  // steps[s - 1] is the place in `pairs` of what turned version s - 1 into version s.
  std::vector<std::size_t> steps;

  // The version in which every pair with persistence below t is cancelled or kept.
  std::size_t version_below(double t, const ReebGraph& full) const;
};

// f(hi) - f(lo).
double persistence(const ReebGraph& graph, const PersistencePair& pair);

// REQUIRES: `pairs` are the extended persistence pairs of `graph`.
// THROWS: std::logic_error if a rule finds no path where the design says there is one.
NaiveHierarchy naive_hierarchy(const ReebGraph& graph, std::vector<PersistencePair> pairs);

}  // namespace reeb::test
