// What the writers of several formats share: the faces of a batch, and lines of text.
#pragma once

#include <charconv>
#include <concepts>

#include "io/file/buffered_writer.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Calls visit(a, b, c) for every triangle of the batch, then for every face of its tetrahedra.
template <class Visit>
void for_each_face(const MeshBatch& batch, Visit visit) {
  for (std::size_t i = 0; i + 2 < batch.triangles.size(); i += 3)
    visit(batch.triangles[i], batch.triangles[i + 1], batch.triangles[i + 2]);
  for (std::size_t i = 0; i + 3 < batch.tetrahedra.size(); i += 4) {
    const VertexId* v = &batch.tetrahedra[i];
    visit(v[0], v[1], v[2]);
    visit(v[0], v[1], v[3]);
    visit(v[0], v[2], v[3]);
    visit(v[1], v[2], v[3]);
  }
}

// One line of a text format, built in the buffer of its file: no allocation per record.
class TextRecord {
 public:
  static constexpr std::size_t kMaxBytes = 4096;

  explicit TextRecord(BufferedWriter& out) : out_(out), begin_(out.reserve_record(kMaxBytes)), end_(begin_) {}
  TextRecord(const TextRecord&) = delete;
  TextRecord& operator=(const TextRecord&) = delete;
  ~TextRecord() { out_.commit_record(static_cast<std::size_t>(end_ - begin_)); }

  void put(char c) { *end_++ = c; }
  void put(std::integral auto number) { end_ = std::to_chars(end_, begin_ + kMaxBytes, number).ptr; }
  // Appends the shortest text that restores the number exactly; -0 becomes 0.
  void put(double number) { end_ = std::to_chars(end_, begin_ + kMaxBytes, number + 0.0).ptr; }

 private:
  BufferedWriter& out_;
  char* begin_;
  char* end_;
};

}  // namespace reeb::io
