// Which vertices have arcs up, and which have arcs down.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::ooc {

// Gathered from all arcs of a graph as they are read, in any order. This locates the extrema without another reading of
// the graph.
//
// MEMORY: bytes(), three bits per vertex.
class ArcEnds {
 public:
  // REQUIRES: the vertices of all arcs are below `vertices`.
  explicit ArcEnds(std::uint64_t vertices);
  static std::uint64_t bytes(std::uint64_t vertices) { return 3 * (vertices / 8 + 8); }

  void add(const ArcKeys& arc) {
    goes_up_[place(arc.lo)] = true;
    goes_down_[place(arc.hi)] = true;
  }

  // Returns the arcs connected, through shared ends, to an arc that touches an extremum of the whole graph; or all
  // arcs, if it takes too many rounds over them to tell.   TIME: O(arcs).
  std::vector<ArcKeys> connected_to_extrema(std::span<const ArcKeys> arcs);

 private:
  static std::size_t place(const SweepKey& key) { return static_cast<std::size_t>(key.vertex.value()); }
  bool ends_in_extremum(const ArcKeys& arc) const { return !goes_down_[place(arc.lo)] || !goes_up_[place(arc.hi)]; }
  // Marks the ends of arcs that touch a marked vertex. Returns whether that marked a new one.
  bool spread(std::span<const ArcKeys> arcs);

  std::vector<bool> goes_up_, goes_down_, near_;  // by vertex
};

}  // namespace reeb::ooc
