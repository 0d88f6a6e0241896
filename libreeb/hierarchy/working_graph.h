// The graph that is simplified step by step. The ends of arcs move; a node finds its arcs in order.
//
// Each node has a heap of the arcs above it, with the nearest upper end on top, and a heap of the arcs below it, with
// the nearest lower end on top. So the nearest arc is found at once, and the arcs that end within an interval are
// enumerated without visiting the others, whatever the degree of the node. They are skew heaps, linked through the
// arcs.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/base/direction.h"
#include "libreeb/base/id_vector.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// A limit that no node is beyond.
constexpr NodeId farthest(Direction d) { return d == kUp ? NodeId::none() : NodeId(0); }

// MEMORY: 36 bytes per arc, 8 bytes per node. Only the constructor and nearest_if() allocate.
class WorkingGraph {
 public:
  static constexpr ArcId kNone = ArcId::none();

  // Arc i of the graph is arc i here. O(m log m).
  explicit WorkingGraph(const ReebGraph& graph);

  NodeId end_node() const { return top_.end_id(); }
  ArcId end_arc() const { return arcs_.end_id(); }
  bool alive(ArcId arc) const { return arcs_[arc].end[kDown] != NodeId::none(); }
  NodeId end(ArcId arc, Direction d) const { return arcs_[arc].end[d]; }

  // The arc of `node` in direction d whose far end is nearest, or kNone.
  ArcId nearest(NodeId node, Direction d) const { return top_[node][d]; }
  // The two arcs below `arc` in the heap that it is in as an arc of direction d; kNone if fewer.
  const std::array<ArcId, 2>& below_in_heap(ArcId arc, Direction d) const { return arcs_[arc].heap[d].child; }
  // True if the node has exactly one arc in direction d.
  bool has_one(NodeId node, Direction d) const {
    const ArcId arc = top_[node][d];
    return arc != kNone && below_in_heap(arc, d) == std::array{kNone, kNone};
  }
  bool is_regular(NodeId node) const { return has_one(node, kUp) && has_one(node, kDown); }

  // Of the arcs of `node` in direction d that `accept` is true for and that end not beyond `limit`, the one with the
  // nearest far end; kNone if there is none. Visits only arcs that are nearer than the answer.
  template <class Accept>
  ArcId nearest_if(NodeId node, Direction d, NodeId limit, Accept accept);

  // Prefetch a node; its nearest arcs; the far ends of these and the arcs below them in their heaps. Each call reads
  // what the one before has fetched.
  void prefetch_node(NodeId node) const { __builtin_prefetch(&top_[node]); }
  void prefetch_arc(ArcId arc) const { __builtin_prefetch(&arcs_[arc]); }
  void prefetch_arcs(NodeId node) const {
    for (const ArcId arc : top_[node])
      if (arc != kNone) prefetch_arc(arc);
  }
  void prefetch_neighbours(NodeId node) const;

  // Moves the end of `arc` on side d to `node`. REQUIRES: its lower end stays below its upper end.
  void move_end(ArcId arc, Direction d, NodeId node);
  void remove(ArcId arc);

 private:
  struct HeapLinks {
    ArcId parent = kNone;
    std::array<ArcId, 2> child{kNone, kNone};
  };
  struct Arc {
    std::array<NodeId, 2> end{NodeId::none(), NodeId::none()};
    std::array<HeapLinks, 2> heap;
  };

  std::uint32_t key(ArcId arc, Direction d) const { return along(d, arcs_[arc].end[d]); }
  ArcId meld(ArcId a, ArcId b, Direction d);
  void insert(ArcId arc, Direction d);
  void erase(ArcId arc, Direction d);

  IdVector<ArcId, Arc> arcs_;
  IdVector<NodeId, std::array<ArcId, 2>> top_;  // of the heaps, by direction
  std::vector<ArcId> stack_;                    // of nearest_if
};

template <class Accept>
ArcId WorkingGraph::nearest_if(NodeId node, Direction d, NodeId limit, Accept accept) {
  ArcId best = kNone;
  stack_.assign(1, top_[node][d]);
  while (!stack_.empty()) {
    const ArcId arc = stack_.back();
    stack_.pop_back();
    if (arc == kNone || key(arc, d) > along(d, limit)) continue;
    if (best != kNone && key(arc, d) >= key(best, d)) continue;
    if (accept(arc))
      best = arc;
    else
      for (const ArcId child : below_in_heap(arc, d)) stack_.push_back(child);
  }
  return best;
}

}  // namespace reeb
