// The layout that PLY and OFF share: a header with counts, all vertices, all faces.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/file/atomic_file.h"
#include "io/mesh/mesh_writer_options.h"

namespace reeb::io {

// Vertices and faces can arrive interleaved, and their counts can be unknown until the end. So room for the header is
// reserved first and filled last, and faces wait in a temporary file until no vertex can follow.
class SectionedFile {
 public:
  SectionedFile(const std::string& path, const MeshWriterOptions& options, std::size_t header_bytes);

  // Returns the writer for the records of `count` more vertices.
  // THROWS: Error{kBadInput} if there are more than announced.
  BufferedWriter& vertices(std::uint64_t count);
  // Returns the writer for the records of `count` more faces.
  BufferedWriter& faces(std::uint64_t count);

  const std::string& path() const { return file_.path(); }
  std::uint64_t vertex_count() const { return vertices_; }
  std::uint64_t face_count() const { return faces_; }

  // REQUIRES: `header` has the size that the constructor was given.
  void commit(const std::string& header);

 private:
  AtomicFile file_;
  std::string temp_folder_;
  std::optional<BufferedWriter> waiting_;  // faces, in the order of their arrival
  std::optional<std::uint64_t> promised_;
  std::uint64_t vertices_ = 0, faces_ = 0;
};

}  // namespace reeb::io
