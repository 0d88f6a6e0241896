// A grid of values as a mesh: the simplices of its division, of which nothing is stored (docs/SEMANTICS.md, Grids).
#pragma once

#include <memory>

#include "libreeb/port/grid_reader.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

struct GridMeshOptions {
  // Leaves out vertices of which a value is NaN, or the one that the header declares for no data, with all simplices
  // that contain them. What stays is every simplex whose vertices all stay.
  bool skip_nodata = false;
  // Numbers the vertices that stay 0, 1, 2, ...; otherwise they have their indices in the grid.
  bool renumber = false;
};

// Vertices come slice by slice, with the properties "value", "value:1" and so on; a slice is finalized when the next
// one is there. Where nothing is skipped, only simplices of the highest dimension are delivered; else also those that
// are in no larger one.
//
// MEMORY: three slices of numbers if vertices are skipped; else nothing that grows with the grid.
// THROWS: Error{kBadInput}: a property that the grid does not have. From read(): a requested value that is not finite,
//         with its place in the file, unless it is skipped.
std::unique_ptr<MeshReader> make_grid_mesh(std::unique_ptr<GridReader> grid, ReadOptions options,
                                           const GridMeshOptions& grid_options = {});

}  // namespace reeb::io
