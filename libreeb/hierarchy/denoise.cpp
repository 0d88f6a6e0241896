#include "libreeb/hierarchy/denoise.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/bucket_lists.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {
namespace {

// Removes leaves of a graph whose arcs it takes; the nodes stay for the caller.
class LeafRemoval {
 public:
  // `whole` says which nodes have all their arcs, all do if it is null; `lists`, of the graph's arcs,
  // may be null. All must outlive this.
  LeafRemoval(ReebGraph& full, const std::vector<bool>* whole, double threshold, ArcBucketLists* lists)
      : full_(full), whole_(whole), threshold_(threshold), graph_(full), lists_(lists), reach_(full.node_count()) {
    find_reaches();
    full.lo = std::vector<NodeId>();
    full.hi = std::vector<NodeId>();
  }

  void run() {
    for (std::uint32_t node = 0; node < graph_.node_count(); ++node) {
      leaves_.push_back(node);
      look_at_leaves();
    }
  }

  std::vector<PersistencePair> take_removed() {
    sort_for_cancelling(full_, removed_);
    return std::move(removed_);
  }

  // The arcs that are left, by (lo, hi).
  std::vector<std::uint32_t> remaining() const {
    std::vector<std::uint32_t> arcs;
    arcs.reserve(graph_.arc_count());
    for (std::uint32_t arc = 0; arc < graph_.arc_count(); ++arc)
      if (graph_.alive(arc)) arcs.push_back(arc);
    const auto key = [this](std::uint32_t arc) {
      return std::tuple(graph_.end(arc, kDown), graph_.end(arc, kUp), arc);
    };
    std::sort(arcs.begin(), arcs.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    return arcs;
  }

  // Puts these arcs into the graph, which still has all nodes.
  void give_back(const std::vector<std::uint32_t>& arcs) const {
    full_.lo.reserve(arcs.size());
    full_.hi.reserve(arcs.size());
    for (const std::uint32_t arc : arcs) {
      full_.lo.emplace_back(graph_.end(arc, kDown));
      full_.hi.emplace_back(graph_.end(arc, kUp));
    }
  }

 private:
  // A leaf is only removed where its saddle reaches beyond it, and joining arcs moves no path: no
  // step ever changes what is found here.
  void find_reaches() {
    for (std::uint32_t node = 0; node < reach_.size(); ++node) reach_[node] = {node, node};
    // Arcs are sorted by lower end, so all that lies below an arc comes before it, all above after.
    for (std::size_t arc = 0; arc < full_.arc_count(); ++arc) {
      std::uint32_t& reach = reach_[full_.hi[arc].value()][kDown];
      reach = std::min(reach, reach_[full_.lo[arc].value()][kDown]);
    }
    for (std::size_t arc = full_.arc_count(); arc-- > 0;) {
      std::uint32_t& reach = reach_[full_.lo[arc].value()][kUp];
      reach = std::max(reach, reach_[full_.hi[arc].value()][kUp]);
    }
  }
  bool reaches_beyond(std::uint32_t node, Direction d, std::uint32_t leaf) const {
    return along(d, reach_[node][d]) > along(d, leaf);
  }

  void look_at_leaves() {
    while (!leaves_.empty()) {
      const std::uint32_t node = leaves_.back();
      leaves_.pop_back();
      for (const Direction d : {kDown, kUp})
        if (is_leaf(node, d)) try_leaf(node, d);
    }
  }

  // True for a maximum (d = kUp) or minimum (d = kDown) with one arc.
  bool is_leaf(std::uint32_t node, Direction d) const {
    return graph_.nearest(node, d) == WorkingGraph::kNone && graph_.has_one(node, opposite(d)) &&
           (whole_ == nullptr || (*whole_)[node]);
  }

  void try_leaf(std::uint32_t leaf, Direction d) {
    const std::uint32_t arc = graph_.nearest(leaf, opposite(d));
    const std::uint32_t saddle = graph_.end(arc, opposite(d));
    if (!reaches_beyond(saddle, d, leaf)) return;
    const PersistencePair pair = d == kUp ? PersistencePair{NodeId(saddle), NodeId(leaf), PairType::kRel1}
                                          : PersistencePair{NodeId(leaf), NodeId(saddle), PairType::kOrd0};
    if (!(persistence_of(full_, pair) < threshold_)) return;
    removed_.push_back(pair);
    graph_.remove(arc);
    if (lists_ != nullptr) lay_aside(arc, saddle, leaf, d);
    settle(saddle);
    if (lists_ != nullptr) lists_->close();
  }

  // The buckets of an arc that was removed, and its leaf, go to the nearest path beyond it.
  void lay_aside(std::uint32_t arc, std::uint32_t saddle, std::uint32_t leaf, Direction d) {
    const auto next = [&](std::uint32_t node) {
      return graph_.nearest_if(node, d, farthest(d),
                               [&](std::uint32_t other) { return reaches_beyond(graph_.end(other, d), d, leaf); });
    };
    std::uint32_t start = saddle, beside = next(saddle);
    for (std::uint32_t end = graph_.end(beside, d); along(d, end) < along(d, leaf); end = graph_.end(beside, d)) {
      const auto [lo, hi] = std::minmax(start, leaf);
      lists_->cut(opposite(d), arc, beside, {value(lo), value(end), value(hi)});
      start = end;
      beside = next(end);
    }
    lists_->merge(arc, beside);
    add_vertex(beside, leaf);
  }

  void add_vertex(std::uint32_t arc, std::uint32_t node) {
    lists_->add(arc, value(node), full_.positions.empty() ? std::array<double, 3>{} : full_.positions[node]);
  }
  double value(std::uint32_t node) const { return full_.nodes[node].value; }

  // A saddle that lost an arc may disappear, which gives leaves beyond it another saddle, or become
  // a leaf itself.
  void settle(std::uint32_t node) {
    if (!graph_.is_regular(node)) {
      leaves_.push_back(node);
      return;
    }
    const std::uint32_t lower = graph_.nearest(node, kDown), upper = graph_.nearest(node, kUp);
    const std::uint32_t bottom = graph_.end(lower, kDown), top = graph_.end(upper, kUp);
    graph_.remove(upper);
    graph_.move_end(lower, kUp, top);
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
  std::vector<std::array<std::uint32_t, 2>> reach_;  // the farthest nodes on monotone paths
  std::vector<std::uint32_t> leaves_;                // nodes that may be leaves to be looked at
  std::vector<PersistencePair> removed_;
};

// Takes out the nodes that have no arc any more; those that had none before stay.
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

void remove_leaves(Denoised& result, const std::vector<bool>* whole, double threshold, ArcBucketLists* lists) {
  const std::vector<NodeId> isolated = isolated_nodes(result.graph);
  {
    LeafRemoval removal(result.graph, whole, threshold, lists);
    removal.run();
    result.removed = removal.take_removed();
    result.former = removal.remaining();
    removal.give_back(result.former);
  }
  drop_lone_nodes(result.graph, isolated);
}

ArcBuckets buckets_of(const ArcBucketLists& lists, const std::vector<std::uint32_t>& arcs) {
  ArcBuckets buckets;
  buckets.offsets.reserve(arcs.size() + 1);
  std::uint64_t end = 0;
  buckets.offsets.push_back(0);
  for (const std::uint32_t arc : arcs) buckets.offsets.push_back(end += packed_count(lists.closed(arc)));
  buckets.buckets.reserve(end);
  for (const std::uint32_t arc : arcs) unpack_buckets(lists.closed(arc), buckets.buckets);
  return buckets;
}

PackedLists lists_of(const ArcBucketLists& lists, const std::vector<std::uint32_t>& arcs) {
  PackedLists packed;
  packed.reserve(arcs.size());
  for (const std::uint32_t arc : arcs) packed.add_packed(lists.closed(arc));
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
