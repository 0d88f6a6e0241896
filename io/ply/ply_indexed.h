// Random access to binary PLY: vertices by index, directly from windows of the file, and the faces in order.
#pragma once

#include <memory>
#include <vector>

#include "io/file/input_file.h"
#include "io/ply/ply_header.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Whether the position of a vertex follows from its index: the file is binary, and all records up to the last vertex
// have a fixed size.
bool has_indexed_vertices(const PlyHeader& header);

// `carried`: of each column, whether it may have any values.
// REQUIRES: has_indexed_vertices(header), and `file` has this header.
std::unique_ptr<IndexedMesh> index_ply(std::shared_ptr<const InputFile> file, const PlyHeader& header,
                                       const ReadOptions& options, const std::vector<bool>& carried);

}  // namespace reeb::io
