// The shared edges that a sweep finds, and the path of each through the graph that the sweep records.
//
// A path is not traced during the sweep. Above a node with one arc up it is implied. At a split, only edges on
// relabelled sides get a note with their branch; all others follow the main branch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/sweep/sweep_graph.h"

namespace reeb {

class SharedEdges {
 public:
  struct Edge {
    SweepNode lo;
    VertexRank hi;
    SweepArc first_arc;
    std::uint32_t place;  // of its last triangle, in the chunk's stream
    std::uint32_t first_note, last_note;
  };

  // Forgets all edges; keeps the memory.
  void start(std::size_t vertices);
  // Says that the sweep arrives at v. To be called for 0, 1, 2, ...
  void reach(VertexRank v) { begin_[v] = static_cast<std::uint32_t>(edges_.size()); }

  // An edge from the vertex that was reached last up to `hi`, whose path starts with `arc`.
  void add(SweepNode lower_node, VertexRank hi, SweepArc arc, std::uint32_t place) {
    edges_.push_back({lower_node, hi, arc, place, kNone, kNone});
  }
  // An edge that no other chunk has, though its ends could be those of one.
  void add_closed(SweepNode lower_node, VertexRank hi) { closed_.push_back({lower_node, hi}); }
  // Notes that the path of the edge that was added last goes up from `node` by `arc`. To be called from below.
  void note_branch(SweepNode node, SweepArc arc) { append_note(edges_.back(), node, arc); }
  // Says that all shared edges up from v were added.
  void finish_vertex(VertexRank v);
  // Notes that the path of lo-hi goes up from `node` by `arc`. Does nothing if lo-hi is not a shared edge.
  void note_branch(VertexRank lo, VertexRank hi, SweepNode node, SweepArc arc);

  std::uint32_t size() const { return static_cast<std::uint32_t>(edges_.size()); }
  const Edge& operator[](std::uint32_t e) const { return edges_[e]; }
  struct ClosedEdge {
    SweepNode lo;
    VertexRank hi;
  };
  const std::vector<ClosedEdge>& closed() const { return closed_; }

  // Calls visit(arc) for each arc on the path of an edge, from below.
  template <class Visit>
  void trace(const Edge& edge, const SweepGraph& graph, const Visit& visit) const;

  std::size_t memory_bytes() const {
    return edges_.capacity() * sizeof(Edge) + notes_.capacity() * sizeof(Note) + 4 * begin_.capacity() +
           closed_.capacity() * sizeof(ClosedEdge);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // The branch that the path of an edge takes at a node, and the edge's next note.
  struct Note {
    SweepNode node;
    SweepArc arc;
    std::uint32_t next;
  };

  void append_note(Edge& edge, SweepNode node, SweepArc arc);

  std::vector<Edge> edges_;                    // by lower vertex; those of a vertex are sorted by hi
  IdVector<VertexRank, std::uint32_t> begin_;  // those of vertex v are begin_[v] .. begin_[v + 1]
  std::vector<Note> notes_;
  std::vector<ClosedEdge> closed_;
};

template <class Visit>
void SharedEdges::trace(const Edge& edge, const SweepGraph& graph, const Visit& visit) const {
  std::uint32_t note = edge.first_note;
  for (SweepArc arc = edge.first_arc;;) {
    visit(arc);
    const SweepNode node = graph.arcs[arc].hi;
    if (graph.nodes[node].vertex == edge.hi) break;
    while (note != kNone && graph.nodes[notes_[note].node].gone) note = notes_[note].next;
    const bool noted = note != kNone && notes_[note].node == node;
    arc = noted ? notes_[note].arc : graph.nodes[node].main_branch;
    if (noted) note = notes_[note].next;
  }
}

}  // namespace reeb
