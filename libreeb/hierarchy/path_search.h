// Finds the arcs and paths that cancelling a pair is about (docs/SEMANTICS.md, Cancelling).
//
// WHY THE SEARCHES ARE SHORT. When the turn of a pair comes, every pair inside its interval is gone, except kept loops.
// So
//  (1) the component of a maximum u above its up-fork v has no other maximum: any path up from v into it ends in u, and
//      any path up from v outside it passes the level of u;
//  (2) no two arcs of v lead into that component, or into the same component of the interlevel set (v, y) of a loop
//      (v, y). Otherwise there would be a loop with lo = v that ends below u, or y, and only a kept loop can.
// Only at a fork with a kept loop is a whole component searched.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "libreeb/containers/kept_ids.h"
#include "libreeb/hierarchy/bounded_search.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// Two paths that start in one node and end in one node, arc by arc.
struct TwoPaths {
  std::vector<ArcId> first, second;
};

// MEMORY: 8.25 bytes per node of the graph. THREADS: as the graph, one at a time.
template <class Graph = WorkingGraph>
class PathSearch {
 public:
  // REQUIRES: `graph` outlives this.
  explicit PathSearch(Graph& graph) : graph_(graph), ahead_(graph), back_(graph) {
    for (std::vector<bool>& nodes : kept_) nodes.resize(graph.end_node().value());
  }

  // To be called when the loop (v, y) is kept.
  void note_kept(NodeId v, NodeId y) {
    kept_[kUp][v.value()] = true;
    kept_[kDown][y.value()] = true;
  }

  // To be called when the graph has renumbered its nodes.
  void renumber(const KeptIds& nodes) {
    for (std::vector<bool>& kept : kept_) {
      // No number rises.
      for (std::uint32_t node = 0; node < kept.size(); ++node)
        if (nodes.has(node)) kept[nodes.rank(node)] = kept[node];
      kept.resize(nodes.count());
    }
    ahead_.restart();
    back_.restart();
  }

  // For a pair of `fork` with the extremum that is its partner in direction d: of the arcs of the fork in this
  // direction, the nearest that leads into the extremum's component, and the nearest that does not.
  struct ForkArcs {
    ArcId in, out;
  };
  ForkArcs arcs_of_fork(Direction d, NodeId fork, NodeId extremum);

  // For a loop (v, y): two paths from v to y in different components of the open interlevel set (v, y). False if there
  // are none.
  bool find_paths(NodeId v, NodeId y, TwoPaths& paths);
  // An arc that joins v and y, or kNone.
  ArcId find_arc(NodeId v, NodeId y);
  // A path from the lower end of `arc` to its upper end without this arc. False if there is none.
  bool find_path_beside(ArcId arc, std::vector<ArcId>& path);

  void prefetch(NodeId node) const {
    ahead_.prefetch(node);
    back_.prefetch(node);
  }

 private:
  static constexpr ArcId kNone = Graph::kNone;

  [[noreturn]] static void not_a_pair() { throw std::logic_error("Canceller: not a pair of this graph"); }

  ArcId arc_to_extremum(Direction d, NodeId fork, NodeId extremum);
  void search_between(NodeId v, NodeId y);
  ArcId second_arc(NodeId v, NodeId y, ArcId first);
  void trace(std::vector<ArcId>& path, NodeId y);
  bool leads(ArcId arc) const { return back_.reached(graph_.end(arc, kUp)); }

  Graph& graph_;
  BoundedSearch<Graph> ahead_;             // from the fork of the pair
  BoundedSearch<Graph> back_;              // from its partner
  std::array<std::vector<bool>, 2> kept_;  // by direction and node: whether a kept loop starts there in that direction
};

// ---- extrema

template <class Graph>
typename PathSearch<Graph>::ForkArcs PathSearch<Graph>::arcs_of_fork(Direction d, NodeId fork, NodeId extremum) {
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
template <class Graph>
ArcId PathSearch<Graph>::arc_to_extremum(Direction d, NodeId fork, NodeId extremum) {
  const bool searched = kept_[d][fork.value()];
  if (const ArcId arc = graph_.nearest(extremum, opposite(d));
      !searched && arc != kNone && graph_.end(arc, opposite(d)) == fork)
    return arc;
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

template <class Graph>
bool PathSearch<Graph>::find_paths(NodeId v, NodeId y, TwoPaths& paths) {
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

template <class Graph>
ArcId PathSearch<Graph>::find_arc(NodeId v, NodeId y) {
  return graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return graph_.end(arc, kUp) == y; });
}

template <class Graph>
bool PathSearch<Graph>::find_path_beside(ArcId arc, std::vector<ArcId>& path) {
  const NodeId v = graph_.end(arc, kDown), y = graph_.end(arc, kUp);
  search_between(v, y);
  const ArcId first = graph_.nearest_if(v, kUp, y, [&](ArcId other) { return other != arc && leads(other); });
  if (first == kNone) return false;
  path.assign(1, first);
  trace(path, y);
  return true;
}

// Makes leads() true for the arcs that can be reached from v and from which a monotone path reaches y.
//
// What can be reached grows fast with the distance. So two searches go up from v and down from y, a band of levels at a
// time, and take their steps in turn until they meet. Below that, the second search goes on among the nodes that the
// first has reached.
template <class Graph>
void PathSearch<Graph>::search_between(NodeId v, NodeId y) {
  constexpr std::uint32_t kBands = 16;
  // Arcs from v to y are left out, since n of them would take n searches of n arcs.
  const std::uint32_t bottom = v.value() + 1, top = y.value() - 1, band = (top - v.value()) / kBands + 1;
  std::uint32_t low = v.value(), high = y.value();  // the levels up to which, and down to which, a search is complete
  const auto band_up = [&] { return NodeId(low + std::min(band, top - low)); };
  const auto band_down = [&] { return NodeId(high - std::min(band, high - bottom)); };
  NodeId up_to = band_up(), down_to = band_down();
  ahead_.start(v, kUp, up_to);
  back_.start(y, kDown, down_to);
  while (low + 1 < high) {
    if (ahead_.step() == kNone) {
      low = up_to.value();
      up_to = band_up();
      ahead_.extend(up_to);
    } else if (back_.step() == kNone) {
      high = down_to.value();
      down_to = band_down();
      back_.extend(down_to);
    }
  }
  back_.extend(NodeId(bottom));
  while (back_.step([&](NodeId node) { return ahead_.reached(node); }) != kNone) {
  }
}

// The nearest arc of v that leads to y in another component of the open interlevel set (v, y) than
// that of the arc `first`; kNone if there is none.
template <class Graph>
ArcId PathSearch<Graph>::second_arc(NodeId v, NodeId y, ArcId first) {
  if (!kept_[kUp][v.value()])
    return graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return arc != first && leads(arc); });
  ahead_.start_both(graph_.end(first, kUp), NodeId(v.value() + 1), NodeId(y.value() - 1));
  ahead_.finish();
  return graph_.nearest_if(v, kUp, y, [&](ArcId arc) { return leads(arc) && !ahead_.reached(graph_.end(arc, kUp)); });
}

// Extends the path to y. At each choice it takes, of the arcs that lead to y, the one with the lowest upper node.
template <class Graph>
void PathSearch<Graph>::trace(std::vector<ArcId>& path, NodeId y) {
  for (NodeId node = graph_.end(path.back(), kUp); node != y; node = graph_.end(path.back(), kUp)) {
    path.push_back(graph_.nearest_if(node, kUp, y, [&](ArcId arc) { return leads(arc); }));
    if (path.back() == kNone) not_a_pair();
  }
}

}  // namespace reeb
