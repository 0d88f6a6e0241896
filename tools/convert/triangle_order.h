// Other orders of the triangles of a mesh, found by sorting on disk.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "io/function_source.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/vertex_function.h"
#include "tools/workspace.h"

namespace reeb::tools {

struct TriangleOrder {
  enum class Kind { kKeep, kHilbert, kSpectral, kSweep };
  Kind kind = Kind::kKeep;
  std::optional<io::FunctionSpec> function;  // of a sweep
};

// "keep", "hilbert", "spectral", "sweep:FUNC". THROWS: Error{kUsage}.
TriangleOrder parse_order(const std::string& text);

// The triangles of `mesh` sorted by their highest corner in the total order of `function`; equal
// ones stay in the order they had. Vertices keep their numbers.
// MEMORY: one share, and the triangles in a log of another. O(n log n), on disk beyond that.
std::unique_ptr<IndexedMesh> sorted_by_function(std::unique_ptr<IndexedMesh> mesh, VertexFunction& function,
                                                Workspace& space);

// The triangles along a Hilbert curve (ooc/reorder.h); `dimension` leading columns are coordinates.
std::unique_ptr<IndexedMesh> sorted_along_hilbert(std::unique_ptr<IndexedMesh> mesh, unsigned dimension,
                                                  Workspace& space);

// The triangles along the Fiedler vector of the mesh (fiedler.h).
std::unique_ptr<IndexedMesh> sorted_by_spectrum(std::unique_ptr<IndexedMesh> mesh, unsigned dimension,
                                                Workspace& space);

}  // namespace reeb::tools
