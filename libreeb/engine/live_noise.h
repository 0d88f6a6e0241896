// Noise in the live graph (docs/SEMANTICS.md, Noise removal): which nodes are near noise, and whether a leaf can go.
#pragma once

#include <vector>

#include "libreeb/base/state_stream.h"
#include "libreeb/engine/path_graph.h"
#include "libreeb/graph/direction.h"

namespace reeb {

// Sets Node::near_noise. Where values are random, hardly any leaf is noise, so only these nodes are examined. The
// threshold often rises with the range of the function, step by step. What is noticed is ahead of it, so that few steps
// have to go over all arcs.
class NearNoise {
 public:
  void set_threshold(PathGraph& graph, double below);
  // An arc with beads does not end at a saddle that could lose it: arcs of its next node were written out.
  bool is_noise(const PathGraph& graph, PathGraph::Index arc) const {
    return graph.length(arc) < noise_below_ && graph.arcs[arc].beads.empty();
  }
  // To be called for an arc that is new, has another end, or is now the only one at one of its ends. An arc that leads
  // to no leaf yet might do so later, when what is beyond it was removed; not if paths lead far beyond both ends.
  void notice(PathGraph& graph, PathGraph::Index arc) const;
  // To be called for a node that has lost an arc.
  void notice_at(PathGraph& graph, PathGraph::Index node) const;

  void save(StateWriter& out) const;
  void restore(StateReader& in);

 private:
  double noise_below_ = 0;
  double noticed_below_ = 0;  // near_noise is set at the ends of a leaf's arc that is shorter, if both are intact
};

// An extremum with one arc, which nothing can change any more except a contraction of its other end.
bool is_leaf(const PathGraph::Node& node);

// Searches for a path from `from` in direction d that reaches beyond the leaf: its arcs replace those of `path`. It
// examines the nearest nodes only, and no more than a few of them; the last pass finds the other leaves.
bool find_path_beyond(const PathGraph& graph, PathGraph::Index from, PathGraph::Index leaf, Direction d,
                      std::vector<PathGraph::Index>& path);

}  // namespace reeb
