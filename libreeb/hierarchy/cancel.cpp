#include "libreeb/hierarchy/cancel.h"

#include <utility>

#include "libreeb/hierarchy/bucket_versions.h"
#include "libreeb/hierarchy/canceller.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"

namespace reeb {
namespace {

// All but the arc records, before anything is cancelled.
Hierarchy paired(const ReebGraph& graph) {
  Hierarchy hierarchy;
  hierarchy.pairs = persistence_pairs(graph);
  hierarchy.isolated = isolated_nodes(graph);
  return hierarchy;
}

// The canceller has the arcs; only the nodes are needed besides.
void release_arcs(ReebGraph& graph) {
  graph.lo = std::vector<NodeId>();
  graph.hi = std::vector<NodeId>();
}

template <class Content>
void cancel_all(const ReebGraph& graph, Canceller<Content>& canceller, Hierarchy& hierarchy, const Poll& poll) {
  constexpr std::size_t kPairsBetweenPolls = 1024;
  std::size_t done = 0;
  for (PersistencePair& pair : hierarchy.pairs) {
    if (pair.type == PairType::kExt0) break;
    if (poll && done++ % kPairsBetweenPolls == 0) poll();
    pair.kept = !canceller.cancel(pair);
    if (!pair.kept) hierarchy.persistence.push_back(persistence_of(graph, pair));
  }
  hierarchy.arcs = canceller.take_records();
}

}  // namespace

Hierarchy build_hierarchy(ReebGraph graph, const Poll& poll) {
  Hierarchy hierarchy = paired(graph);
  Canceller<> canceller(graph);
  release_arcs(graph);
  graph.positions = std::vector<std::array<double, 3>>();
  cancel_all(graph, canceller, hierarchy, poll);
  return hierarchy;
}

Hierarchy build_hierarchy(ReebGraph graph, ArcBuckets& buckets, int exponent, const Poll& poll) {
  if (buckets.offsets.empty()) return build_hierarchy(std::move(graph), poll);
  Hierarchy hierarchy = paired(graph);
  Canceller canceller(graph, BucketVersions(graph, std::move(buckets), exponent));
  release_arcs(graph);
  cancel_all(graph, canceller, hierarchy, poll);
  buckets = canceller.content().take_buckets();
  hierarchy.dropped = canceller.content().take_dropped();
  return hierarchy;
}

}  // namespace reeb
