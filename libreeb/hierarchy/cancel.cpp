#include "libreeb/hierarchy/cancel.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "libreeb/base/prefetch.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/bucket_versions.h"
#include "libreeb/hierarchy/canceller.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"

namespace reeb {
namespace {

// The canceller has a copy of the arcs; of the graph only the nodes are still needed.
void release_arcs(ReebGraph& graph) {
  graph.lo = std::vector<NodeId>();
  graph.hi = std::vector<NodeId>();
}

// Pairs that are near in persistence can be anywhere in memory. Without prefetching, each would wait for memory many
// times.
template <class Content>
void prefetch(const ReebGraph& graph, const Canceller<Content>& canceller, const std::vector<PersistencePair>& pairs,
              std::size_t at) {
  constexpr std::size_t kTurns = 4, kStages = 5;  // pairs from one stage to the next
  if (at + kStages * kTurns >= pairs.size()) return;
  for (const NodeId node : {pairs[at + kTurns].lo, pairs[at + kTurns].hi}) reeb::prefetch(&graph.nodes[node.value()]);
  canceller.prefetch_nodes(pairs[at + 5 * kTurns]);
  canceller.prefetch_arcs(pairs[at + 4 * kTurns]);
  canceller.prefetch_neighbours(pairs[at + 3 * kTurns]);
  canceller.prefetch_next(pairs[at + 2 * kTurns]);
  canceller.prefetch_beyond(pairs[at + kTurns]);
}

template <class Content>
void cancel_all(const ReebGraph& graph, Canceller<Content>& canceller, Hierarchy& hierarchy, const Poll& poll) {
  constexpr std::size_t kPairsBetweenPolls = 1024;
  hierarchy.persistence.reserve(hierarchy.pairs.size());
  for (std::size_t i = 0; i < hierarchy.pairs.size(); ++i) {
    PersistencePair& pair = hierarchy.pairs[i];
    if (pair.type == PairType::kExt0) break;
    if (poll && i % kPairsBetweenPolls == 0) poll(static_cast<double>(i) / static_cast<double>(hierarchy.pairs.size()));
    prefetch(graph, canceller, hierarchy.pairs, i);
    pair.kept = !canceller.cancel(pair);
    if (!pair.kept) hierarchy.persistence.push_back(persistence_of(graph, pair));
  }
  canceller.finish();
}

// Keeps all records; move_to() and buckets() reverse them into the order of a file.
class RecordsInMemory : public RecordSink {
 public:
  void add(const ArcVersion& record, std::span<const std::byte> buckets) override {
    arcs_.push_back(record);
    packed_.insert(packed_.end(), buckets.begin(), buckets.end());
    ends_.push_back(packed_.size());
  }
  void drop(const DroppedVertices& dropped) override { dropped_.push_back(dropped); }

  void move_to(Hierarchy& hierarchy) {
    std::reverse(arcs_.begin(), arcs_.end());
    hierarchy.arcs = std::move(arcs_);
    hierarchy.dropped = std::move(dropped_);
  }
  ArcBuckets buckets() const {
    ArcBuckets result{.offsets = {0}, .buckets = {}};
    for (std::size_t i = ends_.size(); i-- > 0;) {
      const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
      unpack_buckets(std::span(packed_).subspan(begin, ends_[i] - begin), result.buckets);
      result.offsets.push_back(result.buckets.size());
    }
    return result;
  }

 private:
  std::vector<ArcVersion> arcs_;
  std::vector<std::byte> packed_;
  std::vector<std::size_t> ends_;  // in packed_
  std::vector<DroppedVertices> dropped_;
};

}  // namespace

std::uint64_t hierarchy_bytes(std::uint64_t nodes, std::uint64_t arcs, std::optional<std::uint64_t> lists) {
  // Per node: key, position, heaps, searches and sections. Per arc: ends, heaps and the log.
  constexpr std::uint64_t kNodeBytes = 16 + 24 + 16 + 9 + 9, kArcBytes = 8 + 36 + 4,
                          kPairBytes = sizeof(PersistencePair) + sizeof(double);
  const std::uint64_t bytes = kNodeBytes * nodes + kArcBytes * arcs + kPairBytes * std::max(nodes, arcs);
  if (!lists) return bytes;
  // Lists that change leave holes, and a node that is contracted might get a bucket of its own.
  constexpr std::uint64_t kNewBucketBytes = 32;
  return bytes + *lists + *lists / 2 + kNewBucketBytes * nodes;
}

Hierarchy build_hierarchy(ReebGraph& graph, PackedLists buckets, int exponent, RecordSink& sink, const Poll& poll,
                          const DoBoth& both) {
  constexpr double kPairing = 0.3;  // of the time, about
  const Poll pairing = part_of(poll, 0, kPairing), cancelling = part_of(poll, kPairing, 1);
  Hierarchy hierarchy;
  // The sweeps and the working graph together would hold more than cancelling does; sorting holds less.
  UnsortedPairs pairs = unsorted_pairs(graph, pairing, both);
  std::optional<WorkingGraph> working;
  const auto sort = [&] {
    hierarchy.pairs = sorted_pairs(graph, std::move(pairs));
    hierarchy.isolated = isolated_nodes(graph);
  };
  const auto make_working_graph = [&] { working.emplace(graph); };
  both(sort, make_working_graph);
  release_arcs(graph);
  if (buckets.size() == 0) {
    Canceller<> canceller(std::move(*working), sink);
    cancel_all(graph, canceller, hierarchy, cancelling);
  } else {
    Canceller canceller(std::move(*working), sink,
                        BucketVersions(NodesInMemory(graph), std::move(buckets), exponent, sink));
    cancel_all(graph, canceller, hierarchy, cancelling);
  }
  return hierarchy;
}

Hierarchy build_hierarchy(ReebGraph graph, const Poll& poll) {
  RecordsInMemory records;
  Hierarchy hierarchy = build_hierarchy(graph, {}, 0, records, poll);
  records.move_to(hierarchy);
  return hierarchy;
}

Hierarchy build_hierarchy(ReebGraph graph, ArcBuckets& buckets, int exponent, const Poll& poll) {
  RecordsInMemory records;
  Hierarchy hierarchy = build_hierarchy(graph, pack_lists(buckets.view()), exponent, records, poll);
  records.move_to(hierarchy);
  if (!buckets.offsets.empty()) buckets = records.buckets();
  return hierarchy;
}

}  // namespace reeb
