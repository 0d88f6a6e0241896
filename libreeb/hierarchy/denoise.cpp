#include "libreeb/hierarchy/denoise.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {
namespace {

class LeafRemoval {
 public:
  LeafRemoval(const ReebGraph& graph, double threshold)
      : graph_(graph),
        threshold_(threshold),
        ends_(graph.arc_count()),
        nodes_(graph.node_count()),
        leaves_(graph.node_count()) {
    for (std::uint32_t arc = 0; arc < ends_.size(); ++arc) {
      ends_[arc] = {graph.lo[arc].value(), graph.hi[arc].value()};
      attach(ends_[arc][kDown], kUp, arc);
      attach(ends_[arc][kUp], kDown, arc);
    }
    find_reaches();
  }

  Denoised run() {
    std::iota(leaves_.begin(), leaves_.end(), 0u);
    while (!leaves_.empty()) {
      const std::uint32_t node = leaves_.back();
      leaves_.pop_back();
      for (const Direction d : {kDown, kUp})
        if (is_leaf(node, d)) try_leaf(node, d);
    }
    return {remaining(), take_removed()};
  }

 private:
  // The arcs of a node on each side, by their number and the exclusive or of their ids: enough to
  // find the arc of a side that has only one.
  struct Node {
    std::array<std::uint32_t, 2> degree{0, 0};
    std::array<std::uint32_t, 2> arcs_xor{0, 0};
    std::array<std::uint32_t, 2> reach{0, 0};  // the farthest node on monotone paths
  };

  void attach(std::uint32_t node, Direction d, std::uint32_t arc) {
    ++nodes_[node].degree[d];
    nodes_[node].arcs_xor[d] ^= arc;
  }
  void detach(std::uint32_t node, Direction d, std::uint32_t arc) {
    --nodes_[node].degree[d];
    nodes_[node].arcs_xor[d] ^= arc;
  }

  // A leaf is only removed where its saddle reaches beyond it, and joining arcs moves no path: no
  // step ever changes what is found here.
  void find_reaches() {
    for (std::uint32_t node = 0; node < nodes_.size(); ++node) nodes_[node].reach = {node, node};
    // Arcs are sorted by lower end, so all that lies below an arc comes before it, all above after.
    for (const auto& [lo, hi] : ends_)
      nodes_[hi].reach[kDown] = std::min(nodes_[hi].reach[kDown], nodes_[lo].reach[kDown]);
    for (auto arc = ends_.rbegin(); arc != ends_.rend(); ++arc) {
      std::uint32_t& reach = nodes_[(*arc)[kDown]].reach[kUp];
      reach = std::max(reach, nodes_[(*arc)[kUp]].reach[kUp]);
    }
  }

  // True for a maximum (d = kUp) or minimum (d = kDown) with one arc.
  bool is_leaf(std::uint32_t node, Direction d) const {
    return nodes_[node].degree[d] == 0 && nodes_[node].degree[opposite(d)] == 1;
  }

  void try_leaf(std::uint32_t leaf, Direction d) {
    const std::uint32_t arc = nodes_[leaf].arcs_xor[opposite(d)];
    const std::uint32_t saddle = ends_[arc][opposite(d)];
    if (along(d, nodes_[saddle].reach[d]) <= along(d, leaf)) return;
    const PersistencePair pair =
        d == kUp ? PersistencePair{NodeId(saddle), NodeId(leaf), PairType::kRel1}
                 : PersistencePair{NodeId(leaf), NodeId(saddle), PairType::kOrd0};
    if (!(persistence_of(graph_, pair) < threshold_)) return;
    removed_.push_back(pair);
    detach(leaf, opposite(d), arc);
    detach(saddle, d, arc);
    ends_[arc] = {0, 0};
    settle(saddle);
  }

  // A saddle that lost an arc may disappear, which gives leaves beyond it another saddle, or become
  // a leaf itself.
  void settle(std::uint32_t node) {
    if (nodes_[node].degree != std::array{1u, 1u}) {
      leaves_.push_back(node);
      return;
    }
    const std::uint32_t lower = nodes_[node].arcs_xor[kDown], upper = nodes_[node].arcs_xor[kUp];
    const std::uint32_t bottom = ends_[lower][kDown], top = ends_[upper][kUp];
    nodes_[node].degree = {0, 0};
    detach(top, kDown, upper);
    attach(top, kDown, lower);
    ends_[lower][kUp] = top;
    ends_[upper] = {0, 0};
    leaves_.push_back(bottom);
    leaves_.push_back(top);
  }

  ReebGraph remaining() const {
    std::vector<NodeArc> arcs;
    for (const auto& [lo, hi] : ends_)
      if (lo != hi) arcs.push_back({NodeId(lo), NodeId(hi)});
    return subgraph(graph_, std::move(arcs), isolated_nodes(graph_));
  }

  std::vector<PersistencePair> take_removed() {
    sort_for_cancelling(graph_, removed_);
    return std::move(removed_);
  }

  const ReebGraph& graph_;
  const double threshold_;
  std::vector<std::array<std::uint32_t, 2>> ends_;  // equal: the arc is gone
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaves_;  // nodes that may be leaves to be looked at
  std::vector<PersistencePair> removed_;
};

}  // namespace

Denoised denoise(const ReebGraph& graph, double threshold) {
  return LeafRemoval(graph, threshold).run();
}

}  // namespace reeb
