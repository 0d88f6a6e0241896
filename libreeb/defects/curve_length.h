// How long a closed curve is when it is not bound to edges.
#pragma once

#include "libreeb/defects/odd_cycle.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb {

// The length of the path when it is pulled tight across triangles: paths along edges zigzag, and are up to a fifth
// longer. Never more than that of the path, nor much less than a shortest curve near it.
// REQUIRES: left_of(patch, path) exists. TIME: some hundred steps for each edge that leaves the path.
double tight_length(const SurfacePatch& patch, const ClosedPath& path);

}  // namespace reeb
