// The graph that is simplified step by step: arcs whose ends move, found from their nodes in order.
//
// Each node keeps the arcs above it in a heap with the nearest upper end on top, and the arcs below
// it in a heap with the nearest lower end on top. So the arc with the lowest upper node is at hand,
// and all arcs that end within an interval are enumerated without a look at the others, whatever
// the node's degree. The heaps are skew heaps threaded through the arcs.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/base/direction.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// A limit that no node is beyond.
constexpr std::uint32_t farthest(Direction d) { return d == kUp ? ~std::uint32_t{0} : 0; }

// MEMORY: 36 bytes an arc, 8 bytes a node. No operation but the constructor allocates.
class WorkingGraph {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // Arc i of the graph is arc i here. O(m log m).
  explicit WorkingGraph(const ReebGraph& graph);

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(top_.size()); }
  std::uint32_t arc_count() const { return static_cast<std::uint32_t>(arcs_.size()); }
  bool alive(std::uint32_t arc) const { return arcs_[arc].end[kDown] != kNone; }
  std::uint32_t end(std::uint32_t arc, Direction d) const { return arcs_[arc].end[d]; }

  // The arc of `node` in direction d whose far end is nearest, or kNone.
  std::uint32_t nearest(std::uint32_t node, Direction d) const { return top_[node][d]; }
  // The two arcs below `arc` in the heap that it is in as an arc of direction d; kNone if fewer.
  const std::array<std::uint32_t, 2>& below_in_heap(std::uint32_t arc, Direction d) const {
    return arcs_[arc].heap[d].child;
  }
  // True if the node has exactly one arc in direction d.
  bool has_one(std::uint32_t node, Direction d) const {
    const std::uint32_t arc = top_[node][d];
    return arc != kNone && below_in_heap(arc, d) == std::array{kNone, kNone};
  }
  bool is_regular(std::uint32_t node) const { return has_one(node, kUp) && has_one(node, kDown); }

  // The arc of `node` in direction d with the nearest far end of those that `accept`, and not
  // beyond `limit`; kNone if there is none. Looks only at arcs nearer than the answer.
  template <class Accept>
  std::uint32_t nearest_if(std::uint32_t node, Direction d, std::uint32_t limit, Accept accept);

  // Fetches into the caches, without waiting: what is known of a node; its nearest arcs; and what these lie
  // next to. Each but the first reads what the one before has fetched.
  void prefetch_node(std::uint32_t node) const { __builtin_prefetch(&top_[node]); }
  void prefetch_arc(std::uint32_t arc) const { __builtin_prefetch(&arcs_[arc]); }
  void prefetch_arcs(std::uint32_t node) const {
    for (const std::uint32_t arc : top_[node])
      if (arc != kNone) prefetch_arc(arc);
  }
  void prefetch_neighbours(std::uint32_t node) const;

  // Moves the end of `arc` on side d to `node`; its two ends stay in order.
  void move_end(std::uint32_t arc, Direction d, std::uint32_t node);
  void remove(std::uint32_t arc);

 private:
  struct HeapLinks {
    std::uint32_t parent = kNone;
    std::array<std::uint32_t, 2> child{kNone, kNone};
  };
  struct Arc {
    std::array<std::uint32_t, 2> end{kNone, kNone};
    std::array<HeapLinks, 2> heap;
  };

  std::uint32_t key(std::uint32_t arc, Direction d) const { return along(d, arcs_[arc].end[d]); }
  std::uint32_t meld(std::uint32_t a, std::uint32_t b, Direction d);
  void insert(std::uint32_t arc, Direction d);
  void erase(std::uint32_t arc, Direction d);

  std::vector<Arc> arcs_;
  std::vector<std::array<std::uint32_t, 2>> top_;
  std::vector<std::uint32_t> stack_;  // of nearest_if
};

template <class Accept>
std::uint32_t WorkingGraph::nearest_if(std::uint32_t node, Direction d, std::uint32_t limit, Accept accept) {
  std::uint32_t best = kNone;
  stack_.assign(1, top_[node][d]);
  while (!stack_.empty()) {
    const std::uint32_t arc = stack_.back();
    stack_.pop_back();
    if (arc == kNone || key(arc, d) > along(d, limit)) continue;
    if (best != kNone && key(arc, d) >= key(best, d)) continue;
    if (accept(arc))
      best = arc;
    else
      for (const std::uint32_t child : below_in_heap(arc, d)) stack_.push_back(child);
  }
  return best;
}

}  // namespace reeb
