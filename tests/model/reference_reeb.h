// The Reeb graph straight from its definition (DESIGN.md 1.1-1.3), slow and plain: the model that
// the engine is judged by. It shares no code with the engine.
#pragma once

#include "libreeb/graph/reeb_graph.h"
#include "tests/support/complex.h"

namespace reeb::test {

// The graph in canonical form, with the positions of its nodes.
// Takes O(vertices * (edges + triangles)).
ReebGraph reference_reeb(const Complex& complex);

// The same graph, positions unknown: for comparing with a result that does not carry them.
ReebGraph without_positions(ReebGraph graph);

// A graph as text, one node or arc a line, for messages.
std::string describe(const ReebGraph& graph);

}  // namespace reeb::test
