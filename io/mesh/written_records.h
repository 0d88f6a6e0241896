// What the writers of several formats share: the faces of a batch, and lines of text.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <span>

#include "io/file/buffered_writer.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Calls visit(corners) for every simplex of the batch with up to `most` corners, then for every triangle of the others.
template <class Visit>
void for_each_face(const MeshBatch& batch, std::size_t most, const Visit& visit) {
  batch.for_each_simplex([&](std::span<const VertexId> v) {
    if (v.size() <= most) return visit(v);
    for (std::size_t i = 0; i < v.size(); ++i)
      for (std::size_t j = i + 1; j < v.size(); ++j)
        for (std::size_t k = j + 1; k < v.size(); ++k) visit(std::span<const VertexId>(std::array{v[i], v[j], v[k]}));
  });
}

// How many that are with up to three corners.
inline std::uint64_t face_count(const MeshBatch& batch) {
  std::uint64_t faces = batch.simplex_count<2>();
  for (std::size_t k = 3; k < batch.simplices.size(); ++k)
    faces += batch.simplices[k].size() / (k + 1) * ((k + 1) * k * (k - 1) / 6);
  return faces;
}

// A face of up to three corners as a triangle, with its last corner repeated.
inline std::array<VertexId, 3> as_triangle(std::span<const VertexId> face) {
  return {face[0], face[face.size() == 1 ? 0 : 1], face.back()};
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
  void put(double number) { put_signed(number + 0.0); }
  // The same, but -0 stays.
  void put_signed(double number) { end_ = std::to_chars(end_, begin_ + kMaxBytes, number).ptr; }

 private:
  BufferedWriter& out_;
  char* begin_;
  char* end_;
};

}  // namespace reeb::io
