// Vertices and cells of a file become the vertices and simplices of a mesh.
//
// Cells are divided (cell_division.h). Inner nodes of higher-order cells are dropped if no cell has them as corners;
// the vertices that are left keep their order, and are numbered by it. To find these nodes, the cells are read twice.
#pragma once

#include <functional>
#include <memory>

#include "io/cells/cell_input.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Opens the input from its beginning, with the columns of vertices that the options name.
using OpenCells = std::function<std::unique_ptr<CellInput>(const ReadOptions&)>;

// THROWS: what `open` and the steps of the input throw.
std::unique_ptr<MeshReader> read_cells(const OpenCells& open, const ReadOptions& options);

}  // namespace reeb::io
