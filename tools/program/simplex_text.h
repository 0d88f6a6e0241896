// Simplices as messages name them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "libreeb/port/simplex_counts.h"

namespace reeb::tools {

// In the plural: "points", "edges", "triangles", "tetrahedra", "4-simplices", ...
std::string simplices_of_dimension(std::size_t k);

// The counts that are not 0, the largest dimension first: "24,000 tetrahedra, 1 edge". "0 triangles" if there is none.
std::string count_simplices(const SimplexCounts& counts);

// What to say of a surface most of whose triangles share no vertex with others, as many programs write them; else
// empty. Isolated vertices are components without arcs.
std::string text_if_apart(std::uint64_t triangles, std::uint64_t components, std::uint64_t arcs);

}  // namespace reeb::tools
