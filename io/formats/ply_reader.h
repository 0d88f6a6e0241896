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

// A reader of a PLY file that can go back.
class PlyBodyReader : public BatchReader {
 public:
  // Goes to the first element after the vertices, to read the faces from there.
  // REQUIRES: a binary file that can be sought, in which all records up to the last vertex have a fixed size.
  virtual void move_to_faces() = 0;

 protected:
  using BatchReader::BatchReader;
};

// The faces alone of a file whose header is known, as move_to_faces() wants it. Corners are checked against
// the header's count.
std::unique_ptr<PlyBodyReader> open_ply_faces(std::unique_ptr<ContentSource> source, const PlyHeader& header);

}  // namespace reeb::io
