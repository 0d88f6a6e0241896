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

#include "libreeb/containers/kept_ids.h"
#include "libreeb/graph/direction.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/tables_in_memory.h"

namespace reeb {

// A limit that no node is beyond.
constexpr NodeId farthest(Direction d) { return d == kUp ? NodeId::none() : NodeId(0); }

// `TableKind` says where its entries are (libreeb/graph/tables_in_memory.h).
//
// MEMORY: 32 bytes per arc, 16 bytes per node. Only the constructor and nearest_if() allocate.
template <class TableKind = TablesInMemory>
class BasicWorkingGraph {
 public:
  using Tables = TableKind;
  static constexpr ArcId kNone = ArcId::none();

  // Arc i of the graph is arc i here. O(m log m).
  explicit BasicWorkingGraph(const ReebGraph& graph);
  // A graph without arcs: put() makes each of them, once.
  BasicWorkingGraph(std::uint32_t nodes, std::uint32_t arcs, const Tables& tables)
      : tables_(tables),
        arcs_(tables_.template table<ArcId>(arcs, Arc{})),
        top_(tables_.template table<NodeId>(nodes, std::array<Nearest, 2>{})) {}
  // The arcs of a node are put in the order of their numbers. Else the graph is the same, but parallel arcs may take
  // each other's place later.
  void put(ArcId arc, NodeId lo, NodeId hi);

  NodeId end_node() const { return top_.end_id(); }
  ArcId end_arc() const { return arcs_.end_id(); }
  bool alive(ArcId arc) const { return arcs_[arc].end[kDown] != NodeId::none(); }
  NodeId end(ArcId arc, Direction d) const { return arcs_[arc].end[d]; }

  // The arc of `node` in direction d whose far end is nearest, or kNone.
  ArcId nearest(NodeId node, Direction d) const { return top_[node][d].arc; }
  // The far end of this arc; NodeId::none() if there is none.
  NodeId next(NodeId node, Direction d) const { return top_[node][d].end; }
  // The two arcs below `arc` in the heap that it is in as an arc of direction d; kNone if fewer.
  std::array<ArcId, 2> below_in_heap(ArcId arc, Direction d) const { return arcs_[arc].heap[d].child; }
  const Tables& tables() const { return tables_; }
  // True if the node has exactly one arc in direction d.
  bool has_one(NodeId node, Direction d) const {
    const ArcId arc = nearest(node, d);
    return arc != kNone && below_in_heap(arc, d) == std::array{kNone, kNone};
  }
  bool is_regular(NodeId node) const { return has_one(node, kUp) && has_one(node, kDown); }

  // Of the arcs of `node` in direction d that `accept` is true for and that end not beyond `limit`, the one with the
  // nearest far end; kNone if there is none. Visits only arcs that are nearer than the answer.
  template <class Accept>
  ArcId nearest_if(NodeId node, Direction d, NodeId limit, Accept accept);

  // Prefetch a node; its nearest arcs, when the node has arrived.
  void prefetch_node(NodeId node) const { tables_.prefetch(top_, node); }
  void prefetch_arc(ArcId arc) const { tables_.prefetch(arcs_, arc); }
  void prefetch_arcs(NodeId node) const {
    for (const Direction d : {kDown, kUp})
      if (const ArcId arc = nearest(node, d); arc != kNone) prefetch_arc(arc);
  }

  // Moves the end of `arc` on side d to `node`. REQUIRES: its lower end stays below its upper end.
  void move_end(ArcId arc, Direction d, NodeId node);
  void remove(ArcId arc);

  // The nodes and arcs that are left when compact() is called. It gives each its rank among them as its number.
  struct Left {
    KeptIds nodes, arcs;
  };
  // Forgets the numbers of what was removed. The heaps stay as they are.
  Left compact();

 private:
  struct HeapLinks {
    ArcId parent = kNone;
    std::array<ArcId, 2> child{kNone, kNone};
  };
  struct Arc {
    std::array<NodeId, 2> end{NodeId::none(), NodeId::none()};
    std::array<HeapLinks, 2> heap;
  };

  // The top of a heap. Its far end is here, too, so that a path is followed without reading its arcs.
  struct Nearest {
    ArcId arc = kNone;
    NodeId end = NodeId::none();
  };

  std::uint32_t key(ArcId arc, Direction d) const { return along(d, arcs_[arc].end[d]); }
  ArcId meld(ArcId a, ArcId b, Direction d);
  void insert(ArcId arc, Direction d);
  void erase(ArcId arc, Direction d);

  Tables tables_;
  typename Tables::template Table<ArcId, Arc> arcs_;
  typename Tables::template Table<NodeId, std::array<Nearest, 2>> top_;  // by direction
  std::vector<ArcId> stack_;                                             // of nearest_if
};

using WorkingGraph = BasicWorkingGraph<>;

template <class TableKind>
template <class Accept>
ArcId BasicWorkingGraph<TableKind>::nearest_if(NodeId node, Direction d, NodeId limit, Accept accept) {
  ArcId best = kNone;
  stack_.assign(1, nearest(node, d));
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

template <class TableKind>
BasicWorkingGraph<TableKind>::BasicWorkingGraph(const ReebGraph& graph)
    : BasicWorkingGraph(static_cast<std::uint32_t>(graph.node_count()), static_cast<std::uint32_t>(graph.arc_count()),
                        {}) {
  for (ArcId arc; arc < end_arc(); ++arc) put(arc, graph.lo[arc.value()], graph.hi[arc.value()]);
}

template <class TableKind>
void BasicWorkingGraph<TableKind>::put(ArcId arc, NodeId lo, NodeId hi) {
  arcs_[arc].end = {lo, hi};
  insert(arc, kUp);
  insert(arc, kDown);
}

template <class TableKind>
void BasicWorkingGraph<TableKind>::move_end(ArcId arc, Direction d, NodeId node) {
  // The end is the arc's key in the heap at its other end, and names the heap at this one.
  erase(arc, d);
  erase(arc, opposite(d));
  arcs_[arc].end[d] = node;
  insert(arc, d);
  insert(arc, opposite(d));
}

template <class TableKind>
void BasicWorkingGraph<TableKind>::remove(ArcId arc) {
  erase(arc, kUp);
  erase(arc, kDown);
  arcs_[arc].end = {NodeId::none(), NodeId::none()};
}

// Melds two heaps of arcs of direction d. Walks down their right spines, and swaps the children of each arc on the way.
// O(log n) amortized.
template <class TableKind>
ArcId BasicWorkingGraph<TableKind>::meld(ArcId a, ArcId b, Direction d) {
  if (a == kNone) return b;
  if (b == kNone) return a;
  ArcId root = kNone, parent = kNone;
  while (a != kNone && b != kNone) {
    if (key(b, d) < key(a, d)) std::swap(a, b);
    if (parent == kNone)
      root = a;
    else
      arcs_[parent].heap[d].child[0] = a;
    HeapLinks& links = arcs_[a].heap[d];
    links.parent = parent;
    parent = a;
    a = std::exchange(links.child[1], links.child[0]);
  }
  const ArcId rest = a != kNone ? a : b;
  arcs_[parent].heap[d].child[0] = rest;
  arcs_[rest].heap[d].parent = parent;
  return root;
}

template <class TableKind>
void BasicWorkingGraph<TableKind>::insert(ArcId arc, Direction d) {
  arcs_[arc].heap[d] = {};
  const NodeId node = end(arc, opposite(d));
  const ArcId top = meld(nearest(node, d), arc, d);
  top_[node][d] = {top, end(top, d)};
  arcs_[top].heap[d].parent = kNone;
}

template <class TableKind>
void BasicWorkingGraph<TableKind>::erase(ArcId arc, Direction d) {
  const HeapLinks links = std::as_const(arcs_)[arc].heap[d];
  const ArcId rest = meld(links.child[0], links.child[1], d);
  if (rest != kNone) arcs_[rest].heap[d].parent = links.parent;
  if (links.parent == kNone) {
    top_[end(arc, opposite(d))][d] = {rest, rest == kNone ? NodeId::none() : end(rest, d)};
  } else {
    auto& siblings = arcs_[links.parent].heap[d].child;
    siblings[siblings[0] == arc ? 0 : 1] = rest;
  }
}

template <class TableKind>
typename BasicWorkingGraph<TableKind>::Left BasicWorkingGraph<TableKind>::compact() {
  Left left{KeptIds(end_node().value()), KeptIds(end_arc().value())};
  left.nodes.keep_if(
      [this](std::uint32_t id) { return nearest(NodeId(id), kDown) != kNone || nearest(NodeId(id), kUp) != kNone; });
  left.arcs.keep_if([this](std::uint32_t id) { return alive(ArcId(id)); });

  const auto node_now = [&left](NodeId node) {
    return node == NodeId::none() ? node : NodeId(left.nodes.rank(node.value()));
  };
  const auto arc_now = [&left](ArcId arc) { return arc == kNone ? arc : ArcId(left.arcs.rank(arc.value())); };
  // No number rises, so no entry is overwritten before it is moved.
  for (ArcId arc; arc < end_arc(); ++arc) {
    if (!left.arcs.has(arc.value())) continue;
    Arc moved = arcs_[arc];
    for (const Direction d : {kDown, kUp}) {
      moved.end[d] = node_now(moved.end[d]);
      moved.heap[d].parent = arc_now(moved.heap[d].parent);
      for (ArcId& child : moved.heap[d].child) child = arc_now(child);
    }
    arcs_[arc_now(arc)] = moved;
  }
  for (NodeId node; node < end_node(); ++node) {
    if (!left.nodes.has(node.value())) continue;
    std::array<Nearest, 2> moved = top_[node];
    for (Nearest& nearest : moved) nearest = {arc_now(nearest.arc), node_now(nearest.end)};
    top_[node_now(node)] = moved;
  }
  arcs_.resize(left.arcs.count());
  top_.resize(left.nodes.count());
  return left;
}

}  // namespace reeb
