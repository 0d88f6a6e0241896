#include "libreeb/engine/leaf_removal.h"

#include <algorithm>

namespace reeb {

std::size_t LeafRemoval::run(SweepGraph& graph, const SweptChunk& swept, double noise_below) {
  graph_ = &graph;
  swept_ = &swept;
  noise_below_ = noise_below;
  removed_ = 0;
  find_candidates();
  if (candidates_.empty()) return 0;
  prepare();
  while (!candidates_.empty()) {
    const std::uint32_t node = candidates_.back();
    candidates_.pop_back();
    if (!is_used_here_only(node)) continue;
    for (const Direction d : {kDown, kUp})
      if (is_leaf(node, d)) try_leaf(node, d);
  }
  return removed_;
}

std::size_t LeafRemoval::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + 4 * candidates_.capacity();
}

// Every removal begins with a leaf that is one from the start.
void LeafRemoval::find_candidates() {
  candidates_.clear();
  for (const auto& [node, arc] : graph_->leaves)
    if (is_used_here_only(node) && is_noise(arc)) candidates_.push_back(node);
}

// A leaf is only removed where its saddle reaches beyond it, and joining arcs moves no path: no
// step ever changes the reaches that are found here.
void LeafRemoval::prepare() {
  const std::vector<SweepGraph::Arc>& arcs = graph_->arcs;
  nodes_.resize(graph_->nodes.size());
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) nodes_[n] = {{0, 0}, {0, 0}, {n, n}};
  for (std::uint32_t a = 0; a < arcs.size(); ++a) {
    attach(arcs[a].lo, kUp, a);
    attach(arcs[a].hi, kDown, a);
  }
  // All that lies below an arc comes before it, all above after.
  for (const auto& arc : arcs)
    nodes_[arc.hi].reach[kDown] = std::min(nodes_[arc.hi].reach[kDown], nodes_[arc.lo].reach[kDown]);
  for (auto arc = arcs.rbegin(); arc != arcs.rend(); ++arc)
    nodes_[arc->lo].reach[kUp] = std::max(nodes_[arc->lo].reach[kUp], nodes_[arc->hi].reach[kUp]);
}

void LeafRemoval::try_leaf(std::uint32_t leaf, Direction d) {
  const std::uint32_t arc = nodes_[leaf].arcs_xor[opposite(d)];
  const std::uint32_t saddle = graph_->arcs[arc].end(opposite(d));
  if (along(d, nodes_[saddle].reach[d]) <= along(d, leaf) || !is_noise(arc)) return;
  ++removed_;
  detach(leaf, opposite(d), arc);
  detach(saddle, d, arc);
  graph_->arcs[arc].lo = SweepGraph::kNone;
  graph_->nodes[leaf].gone = true;
  settle(saddle);
}

// A saddle that lost an arc may disappear, which gives leaves beyond it another saddle, or become
// a leaf itself. Where it disappears, the lower arc is what both become: paths come to it from
// below, by a branch of the node there.
void LeafRemoval::settle(std::uint32_t saddle) {
  if (nodes_[saddle].degree != std::array{1u, 1u}) {
    candidates_.push_back(saddle);
    return;
  }
  if (!is_used_here_only(saddle)) return;
  const std::uint32_t lower = nodes_[saddle].arcs_xor[kDown], upper = nodes_[saddle].arcs_xor[kUp];
  const std::uint32_t top = graph_->arcs[upper].hi;
  nodes_[saddle].degree = {0, 0};
  detach(top, kDown, upper);
  attach(top, kDown, lower);
  graph_->arcs[lower].hi = top;
  graph_->arcs[upper].lo = SweepGraph::kNone;
  graph_->nodes[saddle].gone = true;
  candidates_.push_back(graph_->arcs[lower].lo);
  candidates_.push_back(top);
}

void LeafRemoval::attach(std::uint32_t node, Direction d, std::uint32_t arc) {
  ++nodes_[node].degree[d];
  nodes_[node].arcs_xor[d] ^= arc;
}

void LeafRemoval::detach(std::uint32_t node, Direction d, std::uint32_t arc) {
  --nodes_[node].degree[d];
  nodes_[node].arcs_xor[d] ^= arc;
}

bool LeafRemoval::is_used_here_only(std::uint32_t node) const {
  return swept_->uses(graph_->nodes[node].vertex) == kUsedHereOnly;
}

bool LeafRemoval::is_noise(std::uint32_t arc) const {
  const auto value = [&](std::uint32_t node) { return swept_->value(graph_->nodes[node].vertex); };
  return value(graph_->arcs[arc].hi) - value(graph_->arcs[arc].lo) < noise_below_;
}

}  // namespace reeb
