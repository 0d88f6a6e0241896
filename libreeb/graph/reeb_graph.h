// A Reeb graph in memory, in the one order in which every result is compared (docs/SEMANTICS.md, Graph).
//
// Nodes are numbered by rank in the total order of their vertices; arcs are sorted by (lo, hi),
// and parallel arcs repeat. Two graphs are equal exactly if their arrays are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/base/sweep_key.h"

namespace reeb {

// Nodes and arcs that are no graph: an arc ends in no node, or a node is there twice. Unless they come from a file,
// this is a fault of the program.
class BrokenGraph : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// A plain value. Any number of threads may read one at the same time. It takes 16 bytes per node (40 with positions)
// and 8 per arc.
struct ReebGraph {
  // One entry per node.
  std::vector<SweepKey> nodes;
  std::vector<std::array<double, 3>> positions;  // empty when unknown
  // One entry per arc: its ends, lo below hi.
  std::vector<NodeId> lo, hi;

  std::size_t node_count() const { return nodes.size(); }
  std::size_t arc_count() const { return lo.size(); }

  friend bool operator==(const ReebGraph&, const ReebGraph&) = default;

  // THROWS: BrokenGraph that names the first node or arc that breaks a rule above.
  void validate() const;
};

// An arc, named by the vertices of its ends, lo below hi. The engine writes out arcs in this form.
struct ArcKeys {
  SweepKey lo, hi;
  friend bool operator==(const ArcKeys&, const ArcKeys&) = default;
};
inline bool operator<(const ArcKeys& a, const ArcKeys& b) noexcept {
  return a.lo < b.lo || (a.lo == b.lo && a.hi < b.hi);
}

// The graph of these arcs and isolated nodes, which may come in any order. O(n log n).
// REQUIRES: lo below hi for each arc; a vertex has the same value everywhere.
ReebGraph make_graph(std::vector<ArcKeys> arcs, std::vector<SweepKey> isolated);

// The numbers of arcs below and above each node.
struct Degrees {
  std::vector<std::uint32_t> down, up;
};
Degrees degrees(const ReebGraph& graph);

struct BettiNumbers {
  std::uint64_t components = 0;  // b0
  std::uint64_t loops = 0;       // b1 = arcs - nodes + components
};
BettiNumbers betti_numbers(const ReebGraph& graph);

}  // namespace reeb
