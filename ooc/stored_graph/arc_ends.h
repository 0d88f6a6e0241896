// Which vertices have arcs up, and which have arcs down.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::ooc {

// Told from all arcs of a graph as they go by, in any order. Then it is known, without another look at
// the graph, where its extrema are.
//
// MEMORY: bytes(), three bits a vertex.
class ArcEnds {
 public:
  // REQUIRES: the vertices of all arcs are below `vertices`.
  explicit ArcEnds(std::uint64_t vertices);
  static std::uint64_t bytes(std::uint64_t vertices) { return 3 * (vertices / 8 + 8); }

  void add(const ArcKeys& arc) {
    goes_up_[place(arc.lo)] = true;
    goes_down_[place(arc.hi)] = true;
  }

  // Of some arcs keeps those that hang together, by each other's ends, with one that rises to a maximum
  // or from a minimum of the whole graph; or all, if it takes more than a few looks at each to tell.
  // O(arcs).
  void keep_near_extrema(std::vector<ArcKeys>& arcs);

 private:
  static std::size_t place(const SweepKey& key) { return static_cast<std::size_t>(key.vertex.value()); }
  bool ends_in_extremum(const ArcKeys& arc) const { return !goes_down_[place(arc.lo)] || !goes_up_[place(arc.hi)]; }
  // Whether an arc of `arcs` came to be near that was not.
  bool spread(const std::vector<ArcKeys>& arcs);

  std::vector<bool> goes_up_, goes_down_, near_;  // by vertex
};

}  // namespace reeb::ooc
