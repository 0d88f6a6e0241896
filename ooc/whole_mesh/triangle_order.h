// Other orders of the triangles of a mesh, found by sorting on disk.
#pragma once

#include <functional>
#include <memory>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/vertex_function.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

// Called often with the part of the work that is done, from 0 to 1.
using SortProgress = std::function<void(double done)>;

// The triangles of `mesh`, sorted by their highest corner in the total order of `function`. Triangles with the same
// highest corner keep their order. Vertices keep their numbers. The function is that of the vertices of the input
// (IndexedMesh::to_original).
// MEMORY: one share, and the triangles in a log of another. O(n log n), on disk beyond that.
std::unique_ptr<IndexedMesh> sorted_by_function(std::unique_ptr<IndexedMesh> mesh, VertexFunction& function,
                                                Workspace& space, const SortProgress& progress = {});

// The triangles along a Hilbert curve (ooc/whole_mesh/reorder.h); `dimension` leading columns are coordinates.
std::unique_ptr<IndexedMesh> sorted_along_hilbert(std::unique_ptr<IndexedMesh> mesh, unsigned dimension,
                                                  Workspace& space, const SortProgress& progress = {});

// The triangles along the Fiedler vector of the mesh (fiedler.h).
std::unique_ptr<IndexedMesh> sorted_by_spectrum(std::unique_ptr<IndexedMesh> mesh, unsigned dimension, Workspace& space,
                                                const SortProgress& progress = {});

}  // namespace reeb::ooc
