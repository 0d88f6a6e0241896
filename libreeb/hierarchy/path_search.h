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

#include <array>
#include <vector>

#include "libreeb/hierarchy/bounded_search.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// Two paths that start in one node and end in one node, arc by arc.
struct TwoPaths {
  std::vector<ArcId> first, second;
};

// MEMORY: 8.25 bytes per node of the graph. THREADS: as the graph, one at a time.
class PathSearch {
 public:
  // REQUIRES: `graph` outlives this.
  explicit PathSearch(WorkingGraph& graph);

  // To be called when the loop (v, y) is kept.
  void note_kept(NodeId v, NodeId y) {
    kept_[kUp][v.value()] = true;
    kept_[kDown][y.value()] = true;
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
  static constexpr ArcId kNone = WorkingGraph::kNone;

  ArcId arc_to_extremum(Direction d, NodeId fork, NodeId extremum);
  void search_between(NodeId v, NodeId y);
  ArcId second_arc(NodeId v, NodeId y, ArcId first);
  void trace(std::vector<ArcId>& path, NodeId y);
  bool leads(ArcId arc) const { return back_.reached(graph_.end(arc, kUp)); }

  WorkingGraph& graph_;
  BoundedSearch ahead_;                    // from the fork of the pair
  BoundedSearch back_;                     // from its partner
  std::array<std::vector<bool>, 2> kept_;  // by direction and node: whether a kept loop starts there in that direction
};

}  // namespace reeb
