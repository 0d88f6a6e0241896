// Noise removal in the live graph.
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "libreeb/engine/live_graph.h"

namespace reeb {

// Where values are random, hardly any leaf is noise. So each node notes whether it is near noise, and only those nodes
// are examined. The threshold often rises with the range of the function, step by step. noticed_below_ is ahead of it,
// so that few steps have to go over all arcs.
void LiveGraph::set_noise(double below) {
  noise_below_ = below;
  if (noise_below_ <= noticed_below_) return;
  noticed_below_ = 2 * noise_below_;
  for (Index a = 0; a < arcs_.size(); ++a)
    if (!arcs_[a].is_free()) notice_noise(a);
}

// To be called for an arc that is new, has another end, or is now the only one at one of its ends. An arc that leads to
// no leaf yet might do so later, when what is beyond it was removed.
void LiveGraph::notice_noise(Index a) {
  if (noticed_below_ == 0 || !arcs_[a].beads.empty()) return;
  Node &lo = nodes_[arcs_[a].lo()], &hi = nodes_[arcs_[a].hi()];
  const double below = has_one_arc(lo) || has_one_arc(hi) ? noticed_below_ : noise_below_;
  if (length(a) < below) lo.near_noise = hi.near_noise = true;
}

// To be called for a node that has lost an arc.
void LiveGraph::notice_noise_at(Index n) {
  const Node& node = nodes_[n];
  if (has_one_arc(node)) notice_noise(node.first(node.degree(kUp) == 1 ? kUp : kDown));
}

// An extremum with one arc, which nothing can change any more except a contraction of its other end.
bool LiveGraph::is_leaf(const Node& n) const {
  return n.intact && has_one_arc(n) && n.referenced_arcs == 0 && n.state != State::kIncomplete;
}

// The node might have become a leaf, or the saddle of one. This is the last moment when all its arcs are certain to be
// here: next, the node might be settled.
void LiveGraph::remove_noise_at(Index n) {
  const Node& node = nodes_[n];
  if (is_leaf(node)) return try_leaf(n);
  if (!node.intact) return;
  for (const Direction d : {kDown, kUp}) {
    // A leaf is removed only if its saddle has another arc in its direction, and its own arc has no references.
    if (node.degree(d) < 2) continue;
    for (Index a = node.first(d); a != kNone;) {
      const Arc& arc = arcs_[a];
      a = arc.next(d);
      if (arc.references == 0 && is_leaf(nodes_[arc.end[d]])) try_leaf(arc.end[d]);
    }
  }
}

void LiveGraph::try_leaf(Index leaf) {
  const Direction d = nodes_[leaf].degree(kDown) == 1 ? kUp : kDown;
  const Index arc = nodes_[leaf].first(opposite(d));
  const Index saddle = arcs_[arc].end[opposite(d)];
  if (!nodes_[saddle].intact) return;
  if (!is_noise(arc)) return;
  if (!find_path_beyond(saddle, leaf, d)) return;
  if (embeds_) move_buckets(arc, leaf, d);
  detach(arc);
  free_arc(arc);
  free_node(leaf);
  notice_noise_at(saddle);
  ++removed_pairs_;
  if (nodes_[saddle].state == State::kSettled) nodes_[saddle].state = State::kComplete;  // it might be contracted
  queue(saddle);
}

// Searches for a path from `from` in direction d that reaches beyond the leaf. It examines the nearest nodes only, and
// no more than a few of them; the last pass finds the other leaves.
bool LiveGraph::find_path_beyond(Index from, Index leaf, Direction d) {
  struct Seen {
    Index node, by_arc;
    std::size_t before;
  };
  constexpr std::size_t kNodesExamined = 16;
  std::array<Seen, kNodesExamined> seen;
  std::size_t count = 0;
  seen[count++] = {from, kNone, 0};
  for (std::size_t i = 0; i < count; ++i)
    for (Index a = nodes_[seen[i].node].first(d); a != kNone; a = arcs_[a].next(d)) {
      const Index end = arcs_[a].end[d];
      if (end == leaf) continue;
      const SweepKey &key = nodes_[end].key, &limit = nodes_[leaf].key;
      if (d == kUp ? limit < key : key < limit) {
        path_.assign(1, a);
        for (std::size_t at = i; at != 0; at = seen[at].before) path_.push_back(seen[at].by_arc);
        std::reverse(path_.begin(), path_.end());
        return true;
      }
      if (count == kNodesExamined) return false;
      seen[count++] = {end, a, i};
    }
  return false;
}

// Adds the arcs that the beads make of an arc, in direction d. Those beyond the leaf get nothing, and are left out.
void LiveGraph::add_path_buckets(Index a, Direction d, double leaf) {
  const BeadChains::Chain chain = arcs_[a].beads;
  const std::size_t first = path_buckets_.size();
  BucketLists::List* buckets = &arc_buckets_[a];
  double above = nodes_[arcs_[a].hi()].key.value;
  for (Index bead = beads_.highest(chain); bead != kNone; bead = beads_.below(chain, bead)) {
    const double below = beads_.key(bead).value;
    if (d == kDown) path_buckets_.push_back({buckets, below});
    if (d == kDown && below <= leaf) return;
    if (d == kUp && below < leaf) path_buckets_.push_back({buckets, above});
    above = below;
    buckets = &beads_.buckets(bead);
  }
  path_buckets_.push_back({buckets, d == kDown ? nodes_[arcs_[a].lo()].key.value : above});
  if (d == kUp) std::reverse(path_buckets_.begin() + static_cast<std::ptrdiff_t>(first), path_buckets_.end());
}

// Moves the vertices of the arc, and the leaf, to the path.
void LiveGraph::move_buckets(Index arc, Index leaf, Direction d) {
  const auto value = [&](Index n) { return nodes_[n].key.value; };
  path_buckets_.clear();
  for (const Index a : path_) add_path_buckets(a, d, value(leaf));
  buckets_.add_vertex(arc_buckets_[arc], value(leaf), track_positions_ ? positions_[leaf] : Point{});
  lay_on_path(buckets_, arc_buckets_[arc], d, value(arcs_[arc].end[opposite(d)]), value(leaf), path_buckets_);
}

}  // namespace reeb
