#include "libreeb/hierarchy/cancel.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/containers/kept_ids.h"
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

constexpr std::size_t kTurns = 4, kStages = 9;  // pairs from one stage of prefetching to the next

// Pairs that are near in persistence can be anywhere in memory. Without prefetching, each would wait for memory many
// times.
template <class Canceller>
void prefetch(const Canceller& canceller, std::span<const PersistencePair> pairs) {
  if (pairs.size() <= kStages * kTurns) return;
  canceller.prefetch_nodes(pairs[9 * kTurns]);
  canceller.prefetch_arcs(pairs[8 * kTurns]);
  canceller.prefetch_neighbours(pairs[7 * kTurns]);
  canceller.prefetch_next(pairs[6 * kTurns]);
  canceller.prefetch_beyond(pairs[5 * kTurns]);
  for (std::size_t nodes = 1; nodes <= 4; ++nodes) canceller.prefetch_path(pairs[(5 - nodes) * kTurns], nodes);
}

// Cancels the pairs of a hierarchy one by one.
template <class Canceller>
class Cancelling {
 public:
  Cancelling(const ReebGraph& graph, Canceller& canceller, Hierarchy& hierarchy, std::size_t shrink)
      : graph_(graph),
        canceller_(canceller),
        hierarchy_(hierarchy),
        left_(all_but_components(hierarchy.pairs)),
        shrink_(shrink),
        numbered_(left_.size() / shrink) {
    hierarchy.persistence.reserve(hierarchy.pairs.size());
  }

  bool is_over() const { return left_.empty(); }
  double done() const { return static_cast<double>(next_) / static_cast<double>(hierarchy_.pairs.size()); }
  void cancel_next() {
    if constexpr (Canceller::Changes::Content::kFollows) {
      if (left_.size() < numbered_ / shrink_) compact();
    }
    if (left_.size() > kTurns)
      for (const NodeId node : {hierarchy_.pairs[next_ + kTurns].lo, hierarchy_.pairs[next_ + kTurns].hi})
        reeb::prefetch(&graph_.nodes[node.value()]);
    prefetch(canceller_, left_);
    PersistencePair& pair = hierarchy_.pairs[next_++];
    pair.kept = !canceller_.cancel(left_.front());
    left_ = left_.subspan(1);
    if (!pair.kept) hierarchy_.persistence.push_back(persistence_of(graph_, pair));
  }

 private:
  static std::span<const PersistencePair> all_but_components(std::span<const PersistencePair> pairs) {
    const auto end =
        std::ranges::find_if(pairs, [](const PersistencePair& pair) { return pair.type == PairType::kExt0; });
    return pairs.first(static_cast<std::size_t>(end - pairs.begin()));
  }

  // WHY. The longest paths are followed near the end, when a few nodes are left among the places of many. Then each
  // step would wait for memory, and nothing can be prefetched.
  void compact() {
    const KeptIds nodes = canceller_.compact();
    const auto now = [&nodes](NodeId node) { return NodeId(nodes.rank(node.value())); };
    std::vector<PersistencePair> pairs(left_.begin(), left_.end());
    for (PersistencePair& pair : pairs) pair = {now(pair.lo), now(pair.hi), pair.type};
    renumbered_ = std::move(pairs);
    left_ = renumbered_;
    numbered_ = left_.size();
  }

  const ReebGraph& graph_;
  Canceller& canceller_;
  Hierarchy& hierarchy_;
  std::size_t next_ = 0;                     // in hierarchy_.pairs
  std::span<const PersistencePair> left_;    // those from there on, in the numbers of the canceller
  std::vector<PersistencePair> renumbered_;  // what left_ is part of, once the canceller has numbers of its own
  std::size_t shrink_, numbered_;            // compact() is called when fewer than numbered_ / shrink_ are left
};

template <class Canceller>
void cancel_all(const ReebGraph& graph, Canceller& canceller, Hierarchy& hierarchy, std::size_t shrink,
                const Poll& poll) {
  constexpr std::size_t kPairsBetweenPolls = 1024;
  Cancelling pairs(graph, canceller, hierarchy, shrink);
  for (std::size_t i = 0; !pairs.is_over(); ++i) {
    if (poll && i % kPairsBetweenPolls == 0) poll(pairs.done());
    pairs.cancel_next();
  }
  canceller.finish();
}

// The same in two threads: the rules run ahead in the other one.
template <class Canceller>
void cancel_ahead(const ReebGraph& graph, Canceller& canceller, Hierarchy& hierarchy, const Poll& poll,
                  const HierarchyWork& work, const RunAhead& limits) {
  using Changes = typename Canceller::Changes;
  Changes& changes = canceller.changes();
  changes.start(*work.turns, limits, canceller.graph().end_arc().value());
  const auto apply = [&] { changes.apply(poll); };
  const auto run_ahead = [&] {
    struct CloseAtEnd {
      Changes& changes;
      ~CloseAtEnd() { changes.close(); }
    } const close{changes};
    try {
      for (Cancelling pairs(graph, canceller, hierarchy, work.shrink); !pairs.is_over(); changes.set_done(pairs.done()))
        pairs.cancel_next();
    } catch (const typename Changes::Stopped&) {  // by an exception that apply() throws
    }
  };
  work.both(apply, run_ahead);
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
    cancel_all(graph, canceller, hierarchy, work.shrink, cancelling);
    return hierarchy;
  }
  BucketVersions versions(NodesInMemory(graph), std::move(buckets), exponent, sink);
  if (!both || work.turns == nullptr) {
    Canceller canceller(std::move(*working), sink, std::move(versions));
    cancel_all(graph, canceller, hierarchy, work.shrink, cancelling);
    return hierarchy;
  }
  Canceller<BucketVersions<>, WorkingGraph, DeferredChanges> canceller(std::move(*working), sink, std::move(versions));
  cancel_ahead(graph, canceller, hierarchy, cancelling, work, limits);
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
