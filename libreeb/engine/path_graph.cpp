#include "libreeb/engine/path_graph.h"

namespace reeb {

void PathGraph::free_arc(Index a) {
  arcs[a].end[kDown] = kNone;
  arcs.free(a);
}

void PathGraph::free_node(Index n) {
  nodes[n].used = false;
  nodes.free(n);
}

void PathGraph::attach(Index a, Direction side, Index n) {
  Arc& arc = arcs[a];
  Node& node = nodes[n];
  arc.end[side] = n;
  Links& links = arc.links[side];
  links = {std::exchange(node.first_at[side], a), kNone};
  if (links.next != kNone) arcs[links.next].links[side].prev = a;
  ++node.degree_at[side];
  if (arc.references != 0) ++node.referenced_arcs;
}

void PathGraph::detach(Index a, Direction side) {
  const Arc& arc = arcs[a];
  Node& node = nodes[arc.end[side]];
  const Links& links = arc.links[side];
  (links.prev == kNone ? node.first_at[side] : arcs[links.prev].links[side].next) = links.next;
  if (links.next != kNone) arcs[links.next].links[side].prev = links.prev;
  --node.degree_at[side];
  if (arc.references != 0) --node.referenced_arcs;
}

void PathGraph::link(Index r, Index a) {
  Arc& arc = arcs[a];
  Reference& reference = references[r];
  reference.arc = a;
  reference.prev = kNone;
  reference.next = std::exchange(arc.first_reference, r);
  if (reference.next != kNone) references[reference.next].prev = r;
  ++arc.references;
}

void PathGraph::unlink(Index r) {
  const Reference& reference = references[r];
  Arc& arc = arcs[reference.arc];
  (reference.prev == kNone ? arc.first_reference : references[reference.prev].next) = reference.next;
  if (reference.next != kNone) references[reference.next].prev = reference.prev;
  --arc.references;
}

bool PathGraph::has_ends(Index top, Index lo, Index hi) const {
  if (arcs[references[top].arc].hi() != hi) return false;
  while (references[top].down != kNone) top = references[top].down;
  return arcs[references[top].arc].lo() == lo;
}

void PathGraph::save(StateWriter& out) const {
  nodes.save(out);
  arcs.save(out);
  references.save(out);
}

void PathGraph::restore(StateReader& in) {
  nodes.restore(in);
  arcs.restore(in);
  references.restore(in);
}

void PathGraph::check_restored_lists() const {
  std::array<std::size_t, 2> arcs_in_lists{};
  for (Index n = 0; n < nodes.size(); ++n)
    for (const Direction side : {kDown, kUp}) {
      if (!nodes[n].used) continue;
      std::size_t degree = 0;
      for (Index a = nodes[n].first_at[side], before = kNone; a != kNone;
           before = a, a = arcs[a].links[side].next, ++degree)
        require_state(a < arcs.size() && !arcs[a].is_free() && arcs[a].end[side] == n &&
                      arcs[a].links[side].prev == before && degree < arcs.size());
      require_state(degree == nodes[n].degree_at[side]);
      arcs_in_lists[side] += degree;
    }
  require_state(arcs_in_lists[kDown] == arcs.used() && arcs_in_lists[kUp] == arcs.used());
}

std::vector<bool> PathGraph::check_restored_paths() {
  std::vector<bool> tops(references.size(), true);
  const std::vector<bool> free = references.restored_free();
  for (Index r = 0; r < references.size(); ++r) {
    if (free[r]) tops[r] = false;
    const Index below = free[r] ? kNone : references[r].down;
    if (below == kNone) continue;
    require_state(below < references.size() && !free[below] && tops[below]);
    require_state(arcs[references[below].arc].hi() == arcs[references[r].arc].lo());
    tops[below] = false;
  }
  return tops;
}

}  // namespace reeb
