// The Reeb graph straight from its definition (docs/SEMANTICS.md, Input, Order and Graph), slow and plain: the model by
// which the engine is judged. It shares no code with the engine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "tests/support/inputs/complex.h"

namespace reeb::test {

// The graph in canonical form, with the positions of its nodes. O(vertices * (edges + triangles)).
ReebGraph reference_reeb(const Complex& complex);

// The same with the vertices that lie on each arc, by index: those on the contours that make up the arc. Parallel arcs
// are ordered by the smallest of them; arcs without vertices come last.
struct ReferenceArcs {
  // What an arc has between two vertices that follow each other in the total order: the edges that cross.
  struct Strip {
    std::uint64_t below = 0, above = 0;
    std::vector<std::array<std::uint64_t, 2>> edges;  // the lower vertex first
  };

  ReebGraph graph;
  std::vector<std::vector<std::uint64_t>> vertices;  // by arc
  std::vector<std::vector<Strip>> strips;            // by arc, from below
};
ReferenceArcs reference_arcs(const Complex& complex);

// The same graph without positions, for comparing with a result that has none.
ReebGraph without_positions(ReebGraph graph);

// A graph as text, one node or arc per line, for messages.
std::string describe(const ReebGraph& graph);

}  // namespace reeb::test
