// Gmsh's MSH, versions 2.2 and 4.1, text and binary.
//
// Nodes are vertices in the order of the file, whatever their tags. $NodeData are properties of vertices, if they list
// the nodes in that order.
#pragma once

#include <memory>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;

// REQUIRES: content->reopen() is not null.
// THROWS: Error{kBadInput} as open_mesh.
std::unique_ptr<MeshReader> open_msh(std::unique_ptr<ContentSource> content, const ReadOptions& options);

}  // namespace reeb::io
