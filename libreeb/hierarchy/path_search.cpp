#include "libreeb/hierarchy/path_search.h"

#include <stdexcept>

namespace reeb {
namespace {

[[noreturn]] void not_a_pair() { throw std::logic_error("Canceller: not a pair of this graph"); }

}  // namespace

PathSearch::PathSearch(WorkingGraph& graph) : graph_(graph), ahead_(graph), back_(graph) {
  for (std::vector<bool>& nodes : kept_) nodes.resize(graph.end_node().value());
}

// ---- extrema

PathSearch::ForkArcs PathSearch::arcs_of_fork(Direction d, NodeId fork, NodeId extremum) {
  const ArcId in = arc_to_extremum(d, fork, extremum);
  const bool searched = kept_[d][fork.value()];
  const ArcId out = graph_.nearest_if(
      fork, d, farthest(d), [&](ArcId arc) { return searched ? !back_.reached(graph_.end(arc, d)) : arc != in; });
  if (in == kNone || out == kNone) not_a_pair();
  return {in, out};
}

// The nearest arc of `fork` that leads into the extremum's component. With a kept loop at the fork there can be several
// such arcs; then back_ has reached the whole component in the end. Otherwise there is one, and the search goes from
// both ends: back from the extremum, and forward from each arc of the fork.
ArcId PathSearch::arc_to_extremum(Direction d, NodeId fork, NodeId extremum) {
  const bool searched = kept_[d][fork.value()];
  back_.start(extremum, opposite(d), fork);
  if (searched) {
    back_.finish();
    return graph_.nearest_if(fork, d, extremum, [&](ArcId arc) { return back_.reached(graph_.end(arc, d)); });
  }
  // The second search visits the fork's own arcs only; each is walked to its end in turn.
  ahead_.start(fork, d, extremum);
  ArcId walker = kNone, walked = kNone;
  while (true) {
    const ArcId back = back_.step();
    if (back != kNone && graph_.end(back, opposite(d)) == fork) return back;
    if (walked == kNone) {
      walker = walked = ahead_.step([](NodeId) { return false; });
      if (walker == kNone && back == kNone) not_a_pair();
      continue;
    }
    const NodeId node = graph_.end(walked, d);
    if (node == extremum) return walker;
    walked = along(d, node) < along(d, extremum) ? graph_.nearest(node, d) : kNone;
  }
}

// ---- loops

bool PathSearch::find_paths(NodeId v, NodeId y, TwoPaths& paths) {
  search_between(v, y);
  const ArcId first = graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return leads(arc); });
  if (first == kNone) return false;
  const ArcId second = second_arc(v, y, first);
  if (second == kNone) return false;
  paths.first.assign(1, first);
  paths.second.assign(1, second);
  trace(paths.first, y);
  trace(paths.second, y);
  return true;
}

ArcId PathSearch::find_arc(NodeId v, NodeId y) {
  return graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return graph_.end(arc, kUp) == y; });
}

bool PathSearch::find_path_beside(ArcId arc, std::vector<ArcId>& path) {
  const NodeId v = graph_.end(arc, kDown), y = graph_.end(arc, kUp);
  search_between(v, y);
  const ArcId first = graph_.nearest_if(v, kUp, y, [&](ArcId other) { return other != arc && leads(other); });
  if (first == kNone) return false;
  path.assign(1, first);
  trace(path, y);
  return true;
}

// Makes leads() true for the arcs that can be reached from v and from which a monotone path reaches y. Searches down
// from y and up from v in turn, until one of the two searches is complete.
void PathSearch::search_between(NodeId v, NodeId y) {
  // Arcs from v to y are left out, since n of them would take n searches of n arcs.
  const NodeId bottom(v.value() + 1), top(y.value() - 1);
  back_.start(y, kDown, bottom);
  ahead_.start(v, kUp, top);
  while (back_.step() != kNone)
    if (ahead_.step() == kNone) {
      back_.start(y, kDown, bottom);
      while (back_.step([&](NodeId node) { return ahead_.reached(node); }) != kNone) {
      }
      return;
    }
}

// The nearest arc of v that leads to y in another component of the open interlevel set (v, y) than
// that of the arc `first`; kNone if there is none.
ArcId PathSearch::second_arc(NodeId v, NodeId y, ArcId first) {
  if (!kept_[kUp][v.value()])
    return graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return arc != first && leads(arc); });
  ahead_.start_both(graph_.end(first, kUp), NodeId(v.value() + 1), NodeId(y.value() - 1));
  ahead_.finish();
  return graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return leads(arc) && !ahead_.reached(graph_.end(arc, kUp)); });
}

// Extends the path to y. At each choice it takes, of the arcs that lead to y, the one with the lowest upper node.
void PathSearch::trace(std::vector<ArcId>& path, NodeId y) {
  for (NodeId node = graph_.end(path.back(), kUp); node != y; node = graph_.end(path.back(), kUp)) {
    path.push_back(graph_.nearest_if(node, kUp, y, [&](ArcId arc) { return leads(arc); }));
    if (path.back() == kNone) not_a_pair();
  }
}

}  // namespace reeb
