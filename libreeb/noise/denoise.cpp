#include "libreeb/noise/denoise.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "libreeb/graph/bucket_lists.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/pair_sweeps.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {
namespace {

// Removes leaves of a graph. It takes the arcs out of the graph; the nodes stay there.
class GraphLeafRemoval {
 public:
  // `whole`: which nodes have all their arcs; if null, all nodes do. `lists`, of the graph's arcs, may be null, and so
  // may `log`.
  // REQUIRES: all arguments outlive this.
  GraphLeafRemoval(ReebGraph& full, const std::vector<bool>* whole, double threshold, ArcBucketLists* lists,
                   ArcLog* log)
      : full_(full), whole_(whole), threshold_(threshold), graph_(full), lists_(lists), log_(log) {
    find_reaches();
    full.lo = std::vector<NodeId>();
    full.hi = std::vector<NodeId>();
  }

  void run() {
    for (NodeId node; node < graph_.end_node(); ++node) {
      leaves_.push_back(node);
      process_leaves();
    }
  }

  std::vector<PersistencePair> take_removed() {
    sort_for_cancelling(full_, removed_);
    return std::move(removed_);
  }

  // The remaining arcs, by (lo, hi).
  std::vector<ArcId> remaining() const {
    std::vector<ArcId> arcs;
    arcs.reserve(graph_.end_arc().value());
    for (ArcId arc; arc < graph_.end_arc(); ++arc)
      if (graph_.alive(arc)) arcs.push_back(arc);
    const auto key = [this](ArcId arc) { return std::tuple(graph_.end(arc, kDown), graph_.end(arc, kUp), arc); };
    std::sort(arcs.begin(), arcs.end(), [&](ArcId a, ArcId b) { return key(a) < key(b); });
    return arcs;
  }

  // Puts these arcs into the graph, which still has all nodes.
  void give_back(const std::vector<ArcId>& arcs) const {
    full_.lo.reserve(arcs.size());
    full_.hi.reserve(arcs.size());
    for (const ArcId arc : arcs) {
      full_.lo.push_back(graph_.end(arc, kDown));
      full_.hi.push_back(graph_.end(arc, kUp));
    }
  }

 private:
  // The reaches never change. A leaf is removed only if its saddle reaches beyond it, and joining arcs changes no path.
  void find_reaches() {
    reach_.resize(full_.node_count());
    for (NodeId node; node < reach_.end_id(); ++node) reach_[node] = {node, node};
    // Arcs are sorted by lower end. So arcs below an arc come before it, arcs above it after it.
    for (std::size_t arc = 0; arc < full_.arc_count(); ++arc) {
      NodeId& reach = reach_[full_.hi[arc]][kDown];
      reach = std::min(reach, reach_[full_.lo[arc]][kDown]);
    }
    for (std::size_t arc = full_.arc_count(); arc-- > 0;) {
      NodeId& reach = reach_[full_.lo[arc]][kUp];
      reach = std::max(reach, reach_[full_.hi[arc]][kUp]);
    }
  }
  bool reaches_beyond(NodeId node, Direction d, NodeId leaf) const {
    return along(d, reach_[node][d]) > along(d, leaf);
  }

  void process_leaves() {
    while (!leaves_.empty()) {
      const NodeId node = leaves_.back();
      leaves_.pop_back();
      for (const Direction d : {kDown, kUp})
        if (is_leaf(node, d)) try_leaf(node, d);
    }
  }

  // True for a maximum (d = kUp) or minimum (d = kDown) with one arc.
  bool is_leaf(NodeId node, Direction d) const {
    return graph_.nearest(node, d) == WorkingGraph::kNone && graph_.has_one(node, opposite(d)) &&
           (whole_ == nullptr || (*whole_)[node.value()]);
  }

  void try_leaf(NodeId leaf, Direction d) {
    const ArcId arc = graph_.nearest(leaf, opposite(d));
    const NodeId saddle = graph_.end(arc, opposite(d));
    if (!reaches_beyond(saddle, d, leaf)) return;
    const PersistencePair pair =
        d == kUp ? PersistencePair{saddle, leaf, PairType::kRel1} : PersistencePair{leaf, saddle, PairType::kOrd0};
    if (!(persistence_of(full_, pair) < threshold_)) return;
    removed_.push_back(pair);
    graph_.remove(arc);
    if (lists_ != nullptr || log_ != nullptr) lay(arc, saddle, leaf, d);
    settle(saddle);
    if (lists_ != nullptr) lists_->close();
  }

  // Lays a removed arc, with its leaf, on the nearest path that reaches beyond the leaf.
  void lay(ArcId arc, NodeId saddle, NodeId leaf, Direction d) {
    const auto next = [&](NodeId node) {
      return graph_.nearest_if(node, d, farthest(d),
                               [&](ArcId other) { return reaches_beyond(graph_.end(other, d), d, leaf); });
    };
    NodeId start = saddle;
    ArcId path_arc = next(saddle);
    for (NodeId end = graph_.end(path_arc, d); along(d, end) < along(d, leaf); end = graph_.end(path_arc, d)) {
      const auto [lo, hi] = std::minmax(start, leaf);
      if (lists_ != nullptr) lists_->cut(opposite(d), arc, path_arc, {value(lo), value(end), value(hi)});
      if (log_ != nullptr) log_->cut(arc.value(), path_arc.value(), key(end), opposite(d));
      start = end;
      path_arc = next(end);
    }
    if (log_ != nullptr) log_->lay(arc.value(), path_arc.value(), key(leaf), opposite(d));
    if (lists_ == nullptr) return;
    lists_->merge(arc, path_arc);
    add_vertex(path_arc, leaf);
  }

  void add_vertex(ArcId arc, NodeId node) {
    lists_->add(arc, value(node), full_.positions.empty() ? std::array<double, 3>{} : full_.positions[node.value()]);
  }
  const SweepKey& key(NodeId node) const { return full_.nodes[node.value()]; }
  double value(NodeId node) const { return key(node).value; }

  // A saddle that lost an arc might become a leaf, or be contracted, which gives leaves beyond it another saddle.
  void settle(NodeId node) {
    if (!graph_.is_regular(node)) {
      leaves_.push_back(node);
      return;
    }
    const ArcId lower = graph_.nearest(node, kDown), upper = graph_.nearest(node, kUp);
    const NodeId bottom = graph_.end(lower, kDown), top = graph_.end(upper, kUp);
    graph_.remove(upper);
    graph_.move_end(lower, kUp, top);
    if (log_ != nullptr) log_->join(upper.value(), lower.value(), key(node), kUp);
    if (lists_ != nullptr) {
      lists_->merge(upper, lower);
      add_vertex(lower, node);
    }
    leaves_.push_back(bottom);
    leaves_.push_back(top);
  }

  ReebGraph& full_;
  const std::vector<bool>* whole_;
  const double threshold_;
  WorkingGraph graph_;
  ArcBucketLists* lists_;
  ArcLog* log_;
  IdVector<NodeId, std::array<NodeId, 2>> reach_;  // the farthest nodes on monotone paths
  std::vector<NodeId> leaves_;                     // nodes to examine, which might be leaves
  std::vector<PersistencePair> removed_;
};

// Removes the nodes that have no arc any more; `isolated` had none before, and stay.
void drop_lone_nodes(ReebGraph& graph, const std::vector<NodeId>& isolated) {
  constexpr std::uint32_t kGone = ~std::uint32_t{0};
  std::vector<std::uint32_t> rank(graph.node_count(), kGone);
  for (const NodeId node : isolated) rank[node.value()] = 0;
  for (const auto* ends : {&graph.lo, &graph.hi})
    for (const NodeId node : *ends) rank[node.value()] = 0;
  std::uint32_t kept = 0;
  for (std::uint32_t node = 0; node < rank.size(); ++node) {
    if (rank[node] == kGone) continue;
    graph.nodes[kept] = graph.nodes[node];
    if (!graph.positions.empty()) graph.positions[kept] = graph.positions[node];
    rank[node] = kept++;
  }
  graph.nodes.resize(kept);
  if (!graph.positions.empty()) graph.positions.resize(kept);
  for (auto* ends : {&graph.lo, &graph.hi})
    for (NodeId& node : *ends) node = NodeId(rank[node.value()]);
}

void remove_leaves(Denoised& result, const std::vector<bool>* whole, double threshold, ArcBucketLists* lists,
                   ArcLog* log = nullptr) {
  const std::vector<NodeId> isolated = isolated_nodes(result.graph);
  {
    GraphLeafRemoval removal(result.graph, whole, threshold, lists, log);
    removal.run();
    result.removed = removal.take_removed();
    result.former = removal.remaining();
    removal.give_back(result.former);
  }
  drop_lone_nodes(result.graph, isolated);
}

ArcBuckets buckets_of(const ArcBucketLists& lists, const std::vector<ArcId>& arcs) {
  ArcBuckets buckets;
  buckets.offsets.reserve(arcs.size() + 1);
  std::uint64_t end = 0;
  buckets.offsets.push_back(0);
  for (const ArcId arc : arcs) buckets.offsets.push_back(end += packed_count(lists.closed(arc)));
  buckets.buckets.reserve(end);
  for (const ArcId arc : arcs) unpack_buckets(lists.closed(arc), buckets.buckets);
  return buckets;
}

PackedLists lists_of(const ArcBucketLists& lists, const std::vector<ArcId>& arcs) {
  PackedLists packed;
  packed.reserve(arcs.size());
  for (const ArcId arc : arcs) packed.add_packed(lists.closed(arc));
  return packed;
}

Denoised denoise_without_embedding(ReebGraph graph, const std::vector<bool>* whole, double threshold) {
  Denoised result{std::move(graph), {}, {}};
  remove_leaves(result, whole, threshold, nullptr);
  return result;
}

}  // namespace

Denoised denoise(ReebGraph graph, double threshold) {
  return denoise_without_embedding(std::move(graph), nullptr, threshold);
}

Denoised denoise(ReebGraph graph, double threshold, ArcLog& log) {
  Denoised result{std::move(graph), {}, {}};
  remove_leaves(result, nullptr, threshold, nullptr, &log);
  for (const ArcId arc : result.former) log.settle(arc.value());
  return result;
}

Denoised denoise(ReebGraph graph, double threshold, ArcBuckets& buckets, int exponent) {
  if (buckets.offsets.empty()) return denoise(std::move(graph), threshold);
  Denoised result{std::move(graph), {}, {}};
  ArcBucketLists lists(pack_lists(buckets.view()), exponent);
  buckets = {};
  remove_leaves(result, nullptr, threshold, &lists);
  buckets = buckets_of(lists, result.former);
  return result;
}

Denoised denoise_part(ReebGraph part, const std::vector<bool>& whole, double threshold, PackedLists& buckets,
                      int exponent) {
  if (buckets.size() == 0) return denoise_without_embedding(std::move(part), &whole, threshold);
  Denoised result{std::move(part), {}, {}};
  ArcBucketLists lists(std::move(buckets), exponent);
  remove_leaves(result, &whole, threshold, &lists);
  buckets = lists_of(lists, result.former);
  return result;
}

}  // namespace reeb
