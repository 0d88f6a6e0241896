// PLY: ASCII and binary of either byte order, any order of elements and properties.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "io/mesh/batch_reader.h"
#include "io/ply/ply_header.h"
#include "libreeb/port/indexed_mesh.h"

namespace reeb::io {

// Reads the header from the beginning of `source`. If the file has faces before their vertices, the vertices are still
// delivered first, so the input must allow seeking.
// THROWS: Error{kBadInput} as open_mesh.
std::unique_ptr<MeshReader> open_ply(std::unique_ptr<ContentSource> source, const ReadOptions& options);

// A reader of the faces of a PLY file that can return to them. It delivers triangles only: an edge is (a, b, b), a
// point (a, a, a). So the order is that of the file, in batches of any size.
class PlyBodyReader : public BatchReader {
 public:
  // Moves to the first element after the vertices, to read the faces from there.
  // REQUIRES: a binary file that allows seeking, with records of fixed size up to the last vertex.
  virtual void move_to_faces() = 0;
  // How many triangles since then were points, and how many edges.
  virtual std::array<std::uint64_t, 2> points_and_edges() const = 0;

  // Where the next face is read, between two triangles; and to go on there. Nothing within a strip or a polygon of very
  // many corners, since a face is read again up to the place.
  virtual std::optional<MeshPlace> place() const = 0;
  virtual void seek(const MeshPlace& place) = 0;
  // Goes on at a face of a file of triangles, and throws Error{kChanged} at a face that is not a triangle.
  virtual void seek_triangle(const PlyTriangles& triangles, std::uint64_t number) = 0;

 protected:
  using BatchReader::BatchReader;
};

// Reads only the faces of a file whose header is known. Corners are checked against the vertex count of the header.
// REQUIRES: as move_to_faces().
std::unique_ptr<PlyBodyReader> open_ply_faces(std::unique_ptr<ContentSource> source, const PlyHeader& header);

}  // namespace reeb::io
