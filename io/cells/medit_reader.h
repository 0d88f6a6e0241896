// Medit's .mesh, text: Vertices, Edges, Triangles, Quadrilaterals, Tetrahedra, Hexahedra, Prisms, Pyramids, and those
// of order 2. Other sections (corners, normals, ...) are passed over.
#pragma once

#include <memory>
#include <string_view>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;

// Comments can come before the first keyword.
bool is_medit(std::string_view head);

// Of version 1, coordinates are float32. REQUIRES: content->reopen() is not null.
// THROWS: Error{kBadInput} as open_mesh.
std::unique_ptr<MeshReader> open_medit(std::unique_ptr<ContentSource> content, const ReadOptions& options);

}  // namespace reeb::io
