// The hierarchy straight from its definition (docs/SEMANTICS.md, Cancelling), with a copy of the graph for each
// version: the model by which the second stage is judged.
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "tests/model/plain_graph.h"

namespace reeb::test {

struct NaiveHierarchy {
  // In the order of cancelling; kept loops are marked. Ext0 pairs come last, sorted in the same way.
  std::vector<PersistencePair> pairs;
  // versions[s] is the graph after s cancellations, versions[0] the full graph. A kept loop is not a cancellation.
  std::vector<ReebGraph> versions;
  // steps[s - 1] is the index in `pairs` of the pair whose cancellation turned version s - 1 into version s.
  std::vector<std::size_t> steps;
  // The given points in each version, and whether they are ambiguous there.
  std::vector<std::vector<PlainGraph::Point>> points;
  std::vector<bool> ambiguous;

  // The version in which every pair with persistence below t is cancelled or kept.
  std::size_t version_below(double t, const ReebGraph& full) const;
};

// f(hi) - f(lo).
double persistence(const ReebGraph& graph, const PersistencePair& pair);

// REQUIRES: `pairs` are the extended persistence pairs of `graph`.
// THROWS: std::logic_error if a rule finds no path where there must be one.
NaiveHierarchy naive_hierarchy(const ReebGraph& graph, std::vector<PersistencePair> pairs,
                               std::vector<PlainGraph::Point> points = {});

}  // namespace reeb::test
