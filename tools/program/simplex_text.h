// Simplices as messages name them.
#pragma once

#include <cstddef>
#include <string>

#include "libreeb/port/simplex_counts.h"

namespace reeb::tools {

// In the plural: "points", "edges", "triangles", "tetrahedra", "4-simplices", ...
std::string simplices_of_dimension(std::size_t k);

// The counts that are not 0, the largest dimension first: "24,000 tetrahedra, 1 edge". "0 triangles" if there is none.
std::string count_simplices(const SimplexCounts& counts);

}  // namespace reeb::tools
