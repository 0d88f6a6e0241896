// The layout that PLY and OFF share: a header with counts, all vertices, all faces.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/file/atomic_file.h"
#include "io/mesh/mesh_writer_options.h"

namespace reeb::io {

// Vertices and faces may arrive interleaved and their counts may be known only at the end: the
// header gets its room first and its bytes last, and faces wait in a temporary file until no
// vertex can follow.
class SectionedFile {
 public:
  SectionedFile(const std::string& path, const MeshWriterOptions& options, std::size_t header_bytes);

  // Where the records of `count` further vertices go.
  // THROWS: Error{kBadInput} if they are more than promised.
  BufferedWriter& vertices(std::uint64_t count);
  // Where the records of `count` further faces go.
  BufferedWriter& faces(std::uint64_t count);

  std::uint64_t vertex_count() const { return vertices_; }
  std::uint64_t face_count() const { return faces_; }

  // REQUIRES: header has the size that the constructor was told.
  void commit(const std::string& header);

 private:
  AtomicFile file_;
  std::string temp_folder_;
  std::optional<BufferedWriter> waiting_;  // faces, in the order of their arrival
  std::optional<std::uint64_t> promised_;
  std::uint64_t vertices_ = 0, faces_ = 0;
};

}  // namespace reeb::io
