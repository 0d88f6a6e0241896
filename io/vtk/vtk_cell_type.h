// The types of cells of VTK, by their numbers in files.
#pragma once

#include <cstdint>

#include "io/cells/cell_input.h"

namespace reeb::io {

// The cell of this type with this number of nodes. Its corners come first.
// THROWS: Error{kBadInput} without a place: a type that is not read, or one that cannot have so few nodes.
CellHead vtk_cell(std::int64_t type, std::uint64_t nodes);

// Whether cells of this type have nodes that are not corners.
bool has_inner_nodes(std::int64_t vtk_type);

}  // namespace reeb::io
