// Noise removal in the live graph.
#include <array>

#include "libreeb/engine/live_graph.h"

namespace reeb {

// An extremum with one arc, which nothing can change any more but a contraction of its other end.
bool LiveGraph::is_leaf(const Node& n) const {
  return n.intact && n.up_degree + n.down_degree == 1 && n.referenced_arcs == 0 &&
         n.state != State::kIncomplete;
}

LiveGraph::Index LiveGraph::first_arc(Index n, Direction d) const {
  return d == kUp ? nodes_[n].up_first : nodes_[n].down_first;
}

// The next arc, in direction d, of the same node.
LiveGraph::Index LiveGraph::next_arc(Index a, Direction d) const {
  return d == kUp ? arcs_[a].lo_next : arcs_[a].hi_next;
}

// The node may have become a leaf, or the saddle of one; before it is settled this is the last moment
// at which all its arcs are there.
void LiveGraph::remove_noise_at(Index n) {
  if (is_leaf(nodes_[n])) return try_leaf(n);
  for (const Direction d : {kDown, kUp})
    for (Index a = first_arc(n, d); a != kNone;) {
      const Index end = arcs_[a].end(d);
      a = next_arc(a, d);
      if (is_leaf(nodes_[end])) try_leaf(end);
    }
}

void LiveGraph::try_leaf(Index leaf) {
  const Direction d = nodes_[leaf].down_degree == 1 ? kUp : kDown;
  const Index arc = first_arc(leaf, opposite(d));
  const Index saddle = arcs_[arc].end(opposite(d));
  if (!nodes_[saddle].intact) return;
  if (!(nodes_[arcs_[arc].hi].key.value - nodes_[arcs_[arc].lo].key.value < noise_below_)) return;
  if (!reaches_beyond(saddle, leaf, d)) return;
  detach_lo(arc);
  detach_hi(arc);
  free_arc(arc);
  free_node(leaf);
  ++removed_pairs_;
  queue(saddle);
}

// Whether another path than that to the leaf is seen to reach beyond it. The nearest nodes are
// looked at, and no more than a few: what they do not show is left to the last pass.
bool LiveGraph::reaches_beyond(Index from, Index leaf, Direction d) const {
  constexpr std::size_t kLooks = 16;
  std::array<Index, kLooks> seen;
  std::size_t count = 0;
  seen[count++] = from;
  for (std::size_t i = 0; i < count; ++i)
    for (Index a = first_arc(seen[i], d); a != kNone; a = next_arc(a, d)) {
      const Index end = arcs_[a].end(d);
      if (end == leaf) continue;
      const SweepKey &key = nodes_[end].key, &limit = nodes_[leaf].key;
      if (d == kUp ? limit < key : key < limit) return true;
      if (count == kLooks) return false;
      seen[count++] = end;
    }
  return false;
}

}  // namespace reeb
