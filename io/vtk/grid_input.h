// The vertices and cells of a file of VTK, read through a cursor for each of its arrays.
#pragma once

#include <memory>

#include "io/cells/cell_input.h"
#include "io/vtk/grid_file.h"

namespace reeb::io {

// Points and cells of the first piece come first, then those of the next one.
// REQUIRES: content->reopen() is not null.
// THROWS: Error{kBadInput} with file, position and hint, here and while reading: counts that the file has no room for,
//         offsets, types and nodes that are impossible, coordinates and chosen values that are not finite, a property
//         that the mesh does not have.
std::unique_ptr<CellInput> open_grid_input(std::shared_ptr<const ContentSource> content,
                                           std::shared_ptr<const GridFile> file, const ReadOptions& options);

// Reads the types of all cells. REQUIRES and THROWS: as above.
bool has_higher_order_cells(const ContentSource& content, const GridFile& file);

}  // namespace reeb::io
