// The surface around defects, cut out of the mesh in one reading.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "ooc/patches/collected_surface.h"
#include "tools/defects/find_defects.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// Calls `visit` with the patch of each row, in their order: the surface around its curve, or around both vertices of a
// row without curves, with at most `most_vertices` vertices, those nearest to the curve along edges.
// MEMORY: that of ooc::DividedSurface, with the surface around a few rows at a time, within the memory of the mesh's
// source. THROWS: Error{kResource} if that does not suffice.
void cut_patches(const ValuedMesh& mesh, const Defects& defects, std::span<const DefectRow* const> rows,
                 std::size_t most_vertices,
                 const std::function<void(std::size_t row, const ooc::CollectedSurface::Patch& patch)>& visit);

}  // namespace reeb::tools
