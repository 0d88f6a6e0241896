#include "libreeb/hierarchy/cancel.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "libreeb/base/prefetch.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/bucket_versions.h"
#include "libreeb/hierarchy/canceller.h"
#include "libreeb/hierarchy/deferred_changes.h"
#include "libreeb/hierarchy/pair_sweeps.h"
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
template <class Canceller>
void prefetch(const ReebGraph& graph, const Canceller& canceller, const std::vector<PersistencePair>& pairs,
              std::size_t at) {
  constexpr std::size_t kTurns = 4, kStages = 9;  // pairs from one stage to the next
  if (at + kStages * kTurns >= pairs.size()) return;
  for (const NodeId node : {pairs[at + kTurns].lo, pairs[at + kTurns].hi}) reeb::prefetch(&graph.nodes[node.value()]);
  canceller.prefetch_nodes(pairs[at + 9 * kTurns]);
  canceller.prefetch_arcs(pairs[at + 8 * kTurns]);
  canceller.prefetch_neighbours(pairs[at + 7 * kTurns]);
  canceller.prefetch_next(pairs[at + 6 * kTurns]);
  canceller.prefetch_beyond(pairs[at + 5 * kTurns]);
  for (std::size_t nodes = 1; nodes <= 4; ++nodes) canceller.prefetch_path(pairs[at + (5 - nodes) * kTurns], nodes);
}

// Cancels the pairs of a hierarchy one by one.
template <class Canceller>
class Cancelling {
 public:
  Cancelling(const ReebGraph& graph, Canceller& canceller, Hierarchy& hierarchy)
      : graph_(graph), canceller_(canceller), hierarchy_(hierarchy) {
    hierarchy.persistence.reserve(hierarchy.pairs.size());
  }

  bool is_over() const { return next_ == hierarchy_.pairs.size() || hierarchy_.pairs[next_].type == PairType::kExt0; }
  double done() const { return static_cast<double>(next_) / static_cast<double>(hierarchy_.pairs.size()); }
  void cancel_next() {
    PersistencePair& pair = hierarchy_.pairs[next_];
    prefetch(graph_, canceller_, hierarchy_.pairs, next_++);
    pair.kept = !canceller_.cancel(pair);
    if (!pair.kept) hierarchy_.persistence.push_back(persistence_of(graph_, pair));
  }

 private:
  const ReebGraph& graph_;
  Canceller& canceller_;
  Hierarchy& hierarchy_;
  std::size_t next_ = 0;
};

template <class Canceller>
void cancel_all(const ReebGraph& graph, Canceller& canceller, Hierarchy& hierarchy, const Poll& poll) {
  constexpr std::size_t kPairsBetweenPolls = 1024;
  Cancelling pairs(graph, canceller, hierarchy);
  for (std::size_t i = 0; !pairs.is_over(); ++i) {
    if (poll && i % kPairsBetweenPolls == 0) poll(pairs.done());
    pairs.cancel_next();
  }
  canceller.finish();
}

// The same in two threads: the rules run ahead in the other one.
template <class Canceller>
void cancel_ahead(const ReebGraph& graph, Canceller& canceller, Hierarchy& hierarchy, const Poll& poll,
                  const DoBoth& both, RingTurns& turns, const RunAhead& limits) {
  using Changes = typename Canceller::Changes;
  Changes& changes = canceller.changes();
  changes.start(turns, limits, canceller.graph().end_arc().value());
  const auto apply = [&] { changes.apply(poll); };
  const auto run_ahead = [&] {
    struct CloseAtEnd {
      Changes& changes;
      ~CloseAtEnd() { changes.close(); }
    } const close{changes};
    try {
      for (Cancelling pairs(graph, canceller, hierarchy); !pairs.is_over(); changes.set_done(pairs.done()))
        pairs.cancel_next();
    } catch (const typename Changes::Stopped&) {  // by an exception that apply() throws
    }
  };
  both(apply, run_ahead);
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
  constexpr std::uint64_t kDeferredArcBytes = sizeof(std::uint16_t);
  return bytes + *lists + *lists / 2 + kNewBucketBytes * nodes + kDeferredArcBytes * arcs +
         (RingTurns::kSlots * sizeof(ArcNote) + 2 * PackedLists::kHeldBytes) * RunAhead::for_arcs(arcs).most_notes();
}

Hierarchy build_hierarchy(ReebGraph& graph, PackedLists buckets, int exponent, RecordSink& sink,
                          const HierarchyWork& work) {
  constexpr double kPairing = 0.3;  // of the time, about
  const Poll pairing = part_of(work.poll, 0, kPairing), cancelling = part_of(work.poll, kPairing, 1);
  const DoBoth& both = work.both;
  Hierarchy hierarchy;
  // The sweeps and the working graph together would hold more than cancelling does; sorting holds less.
  SweptPairs pairs = swept_pairs(graph, pairing, both);
  std::optional<WorkingGraph> working;
  const auto sort = [&] {
    hierarchy.pairs = sorted_pairs(graph, std::move(pairs));
    hierarchy.isolated = isolated_nodes(graph);
  };
  const auto make_working_graph = [&] { working.emplace(graph); };
  do_both(both, sort, make_working_graph);
  const RunAhead limits = work.ahead.value_or(RunAhead::for_arcs(graph.arc_count()));
  release_arcs(graph);
  if (buckets.size() == 0) {
    Canceller<> canceller(std::move(*working), sink);
    cancel_all(graph, canceller, hierarchy, cancelling);
    return hierarchy;
  }
  BucketVersions versions(NodesInMemory(graph), std::move(buckets), exponent, sink);
  if (!both || work.turns == nullptr) {
    Canceller canceller(std::move(*working), sink, std::move(versions));
    cancel_all(graph, canceller, hierarchy, cancelling);
    return hierarchy;
  }
  Canceller<BucketVersions<>, WorkingGraph, DeferredChanges> canceller(std::move(*working), sink, std::move(versions));
  cancel_ahead(graph, canceller, hierarchy, cancelling, both, *work.turns, limits);
  return hierarchy;
}

Hierarchy build_hierarchy(ReebGraph graph, const Poll& poll) {
  RecordsInMemory records;
  Hierarchy hierarchy = build_hierarchy(graph, {}, 0, records, {.poll = poll});
  records.move_to(hierarchy);
  return hierarchy;
}

Hierarchy build_hierarchy(ReebGraph graph, ArcBuckets& buckets, int exponent, const Poll& poll) {
  RecordsInMemory records;
  Hierarchy hierarchy = build_hierarchy(graph, pack_lists(buckets.view()), exponent, records, {.poll = poll});
  records.move_to(hierarchy);
  if (!buckets.offsets.empty()) buckets = records.buckets();
  return hierarchy;
}

}  // namespace reeb
