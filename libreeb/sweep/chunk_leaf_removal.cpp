#include "libreeb/sweep/chunk_leaf_removal.h"

namespace reeb {

std::size_t ChunkLeafRemoval::run(SweepGraph& graph, const SweptChunk& swept, double noise_below) {
  graph_ = &graph;
  swept_ = &swept;
  noise_below_ = noise_below;
  removed_ = 0;
  find_candidates();
  if (candidates_.empty()) return 0;
  choose_whole_nodes();
  prepare();
  while (!candidates_.empty()) {
    const SweepNode node = candidates_.back();
    candidates_.pop_back();
    if (whole_[node] == 0 || !is_used_here_only(node)) continue;
    for (const Direction d : {kDown, kUp})
      if (is_leaf(node, d)) try_leaf(node, d);
  }
  return removed_;
}

std::size_t ChunkLeafRemoval::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + path_.capacity() * sizeof(PathBuckets) + whole_.capacity() +
         4 * (arcs_.capacity() + candidates_.capacity());
}

// The first leaf to be removed is a leaf from the start. So if no such leaf is noise, there is nothing to do.
void ChunkLeafRemoval::find_candidates() {
  candidates_.clear();
  arcs_.clear();
  for (const auto& [node, arc] : graph_->leaves) {
    if (!is_noise(arc) || !is_used_here_only(node)) continue;
    candidates_.push_back(node);
    arcs_.push_back(arc);
  }
}

// All nodes, or leaves and their saddles.
void ChunkLeafRemoval::choose_whole_nodes() {
  constexpr std::size_t kNodesPerLeaf = 32;  // with more, examining all nodes does not pay
  const bool all = candidates_.size() * kNodesPerLeaf >= graph_->nodes.size();
  whole_.assign(graph_->nodes.size(), all ? 1 : 0);
  if (!all)
    for (const SweepArc a : arcs_) whole_[graph_->arcs[a].lo] = whole_[graph_->arcs[a].hi] = 1;
  if (swept_->stars != nullptr) return;
  for (SweepNode n; n < graph_->nodes.end_id(); ++n)
    if (graph_->nodes[n].lost_arcs) whole_[n] = 0;
}

// The reaches that are found here never change. A leaf is removed only if its saddle reaches beyond it, and joining
// arcs changes no path.
void ChunkLeafRemoval::prepare() {
  const auto& arcs = graph_->arcs;
  nodes_.resize(graph_->nodes.size());
  arcs_.clear();
  for (SweepArc a; a < arcs.end_id(); ++a) {
    if ((whole_[arcs[a].lo] | whole_[arcs[a].hi]) == 0) continue;
    arcs_.push_back(a);
    for (const SweepNode n : {arcs[a].lo, arcs[a].hi}) nodes_[n] = {{0, 0}, {0, 0}, {n, n}, {}};
  }
  for (const SweepArc a : arcs_) {
    attach(arcs[a].lo, kUp, a);
    attach(arcs[a].hi, kDown, a);
  }
  // Arcs below an arc come before it, arcs above it after it.
  for (const SweepArc a : arcs_) extend_reach(arcs[a].hi, kDown, a);
  for (auto a = arcs_.rbegin(); a != arcs_.rend(); ++a) extend_reach(arcs[*a].lo, kUp, *a);
}

void ChunkLeafRemoval::extend_reach(SweepNode node, Direction d, SweepArc arc) {
  const SweepNode reach = nodes_[graph_->arcs[arc].end(d)].reach[d];
  if (along(d, reach) <= along(d, nodes_[node].reach[d])) return;
  nodes_[node].reach[d] = reach;
  nodes_[node].via[d] = arc;
}

void ChunkLeafRemoval::try_leaf(SweepNode leaf, Direction d) {
  const SweepArc arc = only_arc(leaf, opposite(d));
  const SweepNode saddle = graph_->arcs[arc].end(opposite(d));
  if (whole_[saddle] == 0 || along(d, nodes_[saddle].reach[d]) <= along(d, leaf) || !is_noise(arc)) return;
  ++removed_;
  if (embeds()) move_buckets(leaf, arc, d);
  detach(leaf, opposite(d), arc);
  detach(saddle, d, arc);
  graph_->arcs[arc].lo = SweepNode::none();
  graph_->nodes[leaf].gone = true;
  settle(saddle);
}

// The path leads to the farthest node that the saddle reaches. In an image with noise it passes thousands of arcs. When
// it has passed a few and has come to the bucket of the leaf, the rest goes whole to the arc there.
void ChunkLeafRemoval::move_buckets(SweepNode leaf, SweepArc arc, Direction d) {
  const std::size_t arcs_to_divide_for = swept_->stars == nullptr ? 16 : graph_->arcs.size();
  path_.clear();
  SweepNode node = graph_->arcs[arc].end(opposite(d));
  const double saddle_value = value(node);
  const int exponent = graph_->buckets.exponent();
  const std::int64_t last_bucket = bucket_index(value(leaf), exponent);
  while (along(d, node) < along(d, leaf)) {
    if (path_.size() >= arcs_to_divide_for && bucket_index(value(node), exponent) == last_bucket) break;
    const SweepArc step = nodes_[node].via[d];
    node = graph_->arcs[step].end(d);
    path_.push_back({&graph_->arc_buckets[step], value(node)});
  }
  BucketLists::List& moved = graph_->arc_buckets[arc];
  // Most leaves have no vertices on their arc.
  if (moved.empty()) return graph_->buckets.add_vertex(*path_.back().list, value(leaf), position(leaf));
  graph_->buckets.add_vertex(moved, value(leaf), position(leaf));
  lay_on_path(graph_->buckets, moved, d, saddle_value, value(leaf), path_);
}

// A saddle that lost an arc might become a leaf, or be contracted, which gives leaves beyond it another saddle.
void ChunkLeafRemoval::settle(SweepNode saddle) {
  if (nodes_[saddle].degree != std::array{1u, 1u}) {
    candidates_.push_back(saddle);
    return;
  }
  if (is_used_here_only(saddle)) contract(saddle);
}

// Both arcs become the lower one, since paths reach it from below, through a branch of its lower node.
void ChunkLeafRemoval::contract(SweepNode node) {
  const SweepArc lower = only_arc(node, kDown), upper = only_arc(node, kUp);
  const SweepNode top = graph_->arcs[upper].hi;
  if (embeds()) {
    graph_->buckets.concatenate(graph_->arc_buckets[lower], value(node), position(node), graph_->arc_buckets[upper]);
  }
  nodes_[node].degree = {0, 0};
  if (nodes_[top].via[kDown] == upper) nodes_[top].via[kDown] = lower;
  detach(top, kDown, upper);
  attach(top, kDown, lower);
  graph_->arcs[lower].hi = top;
  graph_->arcs[upper].join(lower);
  graph_->nodes[node].gone = true;
  candidates_.push_back(graph_->arcs[lower].lo);
  candidates_.push_back(top);
}

void ChunkLeafRemoval::attach(SweepNode node, Direction d, SweepArc arc) {
  ++nodes_[node].degree[d];
  nodes_[node].arcs_xor[d] ^= arc.value();
}

void ChunkLeafRemoval::detach(SweepNode node, Direction d, SweepArc arc) {
  --nodes_[node].degree[d];
  nodes_[node].arcs_xor[d] ^= arc.value();
}

}  // namespace reeb
