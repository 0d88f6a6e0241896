#include "libreeb/sweep/shared_edges.h"

#include <algorithm>

namespace reeb {

void SharedEdges::start(std::size_t vertices) {
  edges_.clear();
  notes_.clear();
  closed_.clear();
  begin_.resize(vertices + 1);
}

void SharedEdges::finish_vertex(VertexRank v) {
  std::sort(edges_.begin() + begin_[v], edges_.end(), [](const Edge& a, const Edge& b) { return a.hi < b.hi; });
}

void SharedEdges::note_branch(VertexRank lo, VertexRank hi, SweepNode node, SweepArc arc) {
  const auto first = edges_.begin() + begin_[lo], last = edges_.begin() + begin_[VertexRank(lo.value() + 1)];
  const auto edge = std::lower_bound(first, last, hi, [](const Edge& e, VertexRank h) { return e.hi < h; });
  if (edge == last || edge->hi != hi) return;
  if (edge->last_note != kNone && notes_[edge->last_note].node == node) return;
  append_note(*edge, node, arc);
}

void SharedEdges::append_note(Edge& edge, SweepNode node, SweepArc arc) {
  const auto note = static_cast<std::uint32_t>(notes_.size());
  notes_.push_back({node, arc, kNone});
  (edge.first_note == kNone ? edge.first_note : notes_[edge.last_note].next) = note;
  edge.last_note = note;
}

}  // namespace reeb
