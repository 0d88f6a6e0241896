// Random Reeb graphs that no complex need bear: denser in loops than those of small complexes.
#pragma once

#include <cstdint>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::test {

// Without (1, 1) nodes, with parallel arcs, several parts and tied values; up to about 16 nodes.
ReebGraph random_graph(std::uint64_t seed);

// The same made of this many arcs, less what contracting (1, 1) nodes takes.
ReebGraph random_graph(std::uint64_t seed, std::size_t arcs);

}  // namespace reeb::test
