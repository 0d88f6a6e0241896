// Noise removal in the live graph.
#include <algorithm>
#include <cstddef>

#include "libreeb/engine/live_graph.h"

namespace reeb {

// The node might have become a leaf, or the saddle of one. This is the last moment when all its arcs are certain to be
// here: next, the node might be settled.
void LiveGraph::remove_noise_at(Index n) {
  const Node& node = graph_.nodes[n];
  if (is_leaf(node)) return try_leaf(n);
  if (!node.intact) return;
  for (const Direction d : {kDown, kUp}) {
    // A leaf is removed only if its saddle has another arc in its direction, and its own arc has no references.
    if (node.degree(d) < 2) continue;
    for (Index a = node.first(d); a != kNone;) {
      const Arc& arc = graph_.arcs[a];
      a = arc.next(d);
      if (arc.references == 0 && is_leaf(graph_.nodes[arc.end[d]])) try_leaf(arc.end[d]);
    }
  }
}

void LiveGraph::try_leaf(Index leaf) {
  const Direction d = graph_.nodes[leaf].degree(kDown) == 1 ? kUp : kDown;
  const Index arc = graph_.nodes[leaf].first(opposite(d));
  const Index saddle = graph_.arcs[arc].end[opposite(d)];
  if (!graph_.nodes[saddle].intact) return;
  if (!noise_.is_noise(graph_, arc)) return;
  if (!find_path_beyond(graph_, saddle, leaf, d, path_)) return;
  if (embeds_) move_buckets(arc, leaf, d);
  graph_.detach(arc);
  graph_.free_arc(arc);
  graph_.free_node(leaf);
  noise_.notice_at(graph_, saddle);
  ++removed_pairs_;
  if (graph_.nodes[saddle].state == State::kSettled)
    graph_.nodes[saddle].state = State::kComplete;  // it might be contracted
  queue(saddle);
}

// Adds the arcs that the beads make of an arc, in direction d. Those beyond the leaf get nothing, and are left out.
void LiveGraph::add_path_buckets(Index a, Direction d, double leaf) {
  const BeadChains::Chain chain = graph_.arcs[a].beads;
  const std::size_t first = path_buckets_.size();
  BucketLists::List* buckets = &arc_buckets_[a];
  double above = graph_.nodes[graph_.arcs[a].hi()].key.value;
  for (Index bead = beads_.highest(chain); bead != kNone; bead = beads_.below(chain, bead)) {
    const double below = beads_.key(bead).value;
    if (d == kDown) path_buckets_.push_back({buckets, below});
    if (d == kDown && below <= leaf) return;
    if (d == kUp && below < leaf) path_buckets_.push_back({buckets, above});
    above = below;
    buckets = &beads_.buckets(bead);
  }
  path_buckets_.push_back({buckets, d == kDown ? graph_.nodes[graph_.arcs[a].lo()].key.value : above});
  if (d == kUp) std::reverse(path_buckets_.begin() + static_cast<std::ptrdiff_t>(first), path_buckets_.end());
}

// Moves the vertices of the arc, and the leaf, to the path.
void LiveGraph::move_buckets(Index arc, Index leaf, Direction d) {
  const auto value = [&](Index n) { return graph_.nodes[n].key.value; };
  path_buckets_.clear();
  for (const Index a : path_) add_path_buckets(a, d, value(leaf));
  buckets_.add_vertex(arc_buckets_[arc], value(leaf), track_positions_ ? positions_[leaf] : Point{});
  lay_on_path(buckets_, arc_buckets_[arc], d, value(graph_.arcs[arc].end[opposite(d)]), value(leaf), path_buckets_);
}

}  // namespace reeb
