#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

WorkingGraph::WorkingGraph(const ReebGraph& graph) {
  arcs_.resize(graph.arc_count());
  top_.assign(graph.node_count(), {kNone, kNone});
  for (ArcId arc; arc < end_arc(); ++arc) {
    arcs_[arc].end = {graph.lo[arc.value()], graph.hi[arc.value()]};
    insert(arc, kUp);
    insert(arc, kDown);
  }
}

void WorkingGraph::prefetch_neighbours(NodeId node) const {
  for (const Direction d : {kDown, kUp}) {
    if (top_[node][d] == kNone) continue;
    const Arc& arc = arcs_[top_[node][d]];
    prefetch_node(arc.end[d]);
    for (const ArcId child : arc.heap[d].child)
      if (child != kNone) prefetch_arc(child);
  }
}

void WorkingGraph::move_end(ArcId arc, Direction d, NodeId node) {
  // The end is the arc's key in the heap at its other end, and names the heap at this one.
  erase(arc, d);
  erase(arc, opposite(d));
  arcs_[arc].end[d] = node;
  insert(arc, d);
  insert(arc, opposite(d));
}

void WorkingGraph::remove(ArcId arc) {
  erase(arc, kUp);
  erase(arc, kDown);
  arcs_[arc].end = {NodeId::none(), NodeId::none()};
}

// Melds two heaps of arcs of direction d. Walks down their right spines, and swaps the children of each arc on the way.
// O(log n) amortized.
ArcId WorkingGraph::meld(ArcId a, ArcId b, Direction d) {
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

void WorkingGraph::insert(ArcId arc, Direction d) {
  arcs_[arc].heap[d] = {};
  ArcId& top = top_[arcs_[arc].end[opposite(d)]][d];
  top = meld(top, arc, d);
  arcs_[top].heap[d].parent = kNone;
}

void WorkingGraph::erase(ArcId arc, Direction d) {
  const HeapLinks links = arcs_[arc].heap[d];
  const ArcId rest = meld(links.child[0], links.child[1], d);
  if (rest != kNone) arcs_[rest].heap[d].parent = links.parent;
  if (links.parent == kNone) {
    top_[arcs_[arc].end[opposite(d)]][d] = rest;
  } else {
    auto& siblings = arcs_[links.parent].heap[d].child;
    siblings[siblings[0] == arc ? 0 : 1] = rest;
  }
}

}  // namespace reeb
