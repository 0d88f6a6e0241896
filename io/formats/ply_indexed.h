// Binary PLY in place: vertices by index, straight from mapped windows, and the faces in order.
#pragma once

#include <memory>
#include <string>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Null unless `path` is an uncompressed binary PLY file with vertices of fixed size that stand
// before all faces.
// THROWS: Error{kBadInput} as open_mesh, where it is a PLY file.
std::unique_ptr<IndexedMesh> open_indexed_ply(const std::string& path, const ReadOptions& options);

}  // namespace reeb::io
