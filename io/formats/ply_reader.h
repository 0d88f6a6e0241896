// PLY: ASCII and binary of either byte order, any order of elements and properties.
#pragma once

#include <memory>

#include "io/formats/ply_header.h"
#include "io/mesh/batch_reader.h"

namespace reeb::io {

// Reads the header from the beginning of `source`. Where faces stand before their vertices, the
// vertices are delivered first, which takes an input that can be read twice.
// THROWS: Error{kBadInput} as open_mesh.
std::unique_ptr<MeshReader> open_ply(std::unique_ptr<ContentSource> source, const ReadOptions& options);

// The faces alone of an uncompressed file whose header is known, from the first element behind the
// vertices, whose records have a fixed size. Corners are checked against the header's count.
std::unique_ptr<BatchReader> open_ply_faces(std::unique_ptr<ContentSource> source, const PlyHeader& header);

}  // namespace reeb::io
