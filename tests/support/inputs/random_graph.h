// Random Reeb graphs that were not made from a complex. They have more loops than those of small complexes.
#pragma once

#include <cstdint>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::test {

// Without (1, 1) nodes; with parallel arcs, several components and tied values; up to about 16 nodes.
ReebGraph random_graph(std::uint64_t seed);

// The same from this number of arcs, some of which contracting (1, 1) nodes removes.
ReebGraph random_graph(std::uint64_t seed, std::size_t arcs);

}  // namespace reeb::test
