// A contiguous share of the triangles of a mesh, as a mesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/simplex_counts.h"

namespace reeb::ooc {

// All shares have the same number of triangles, except that the last ones have fewer, or none. The vertices that no
// triangle names are divided in the same way.
struct Shares {
  std::uint64_t triangles = 0, vertices = 0;
  std::uint32_t parts = 1;

  std::uint64_t size() const { return std::max<std::uint64_t>(1, (triangles + parts - 1) / parts); }
  std::uint64_t begin(std::uint32_t part) const { return std::min(triangles, part * size()); }
  std::uint64_t end(std::uint32_t part) const { return std::min(triangles, (part + std::uint64_t{1}) * size()); }
  // REQUIRES: there are triangles.
  std::uint32_t part_of(std::uint64_t triangle) const {
    return static_cast<std::uint32_t>(std::min(triangle, triangles - 1) / size());
  }
  std::uint64_t first_vertex(std::uint32_t part) const {
    return std::min(vertices, part * std::max<std::uint64_t>(1, (vertices + parts - 1) / parts));
  }
};

// The triangles from `begin` to `end` of `mesh`, which must outlive it. Vertices keep their numbers. If `by_size`,
// triangles are where sizes tell: IndexedMesh::seek_triangle().
class MeshShare : public IndexedMesh {
 public:
  MeshShare(IndexedMesh& mesh, std::uint64_t begin, std::uint64_t end, bool by_size)
      : mesh_(mesh), begin_(begin), end_(end), by_size_(by_size) {}

  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }
  unsigned column_count() const override { return mesh_.column_count(); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    mesh_.gather(ids, columns, values);
  }
  void to_original(std::span<VertexId> ids) override { mesh_.to_original(ids); }
  std::uint64_t number_count() const override { return mesh_.number_count(); }
  void from_original(std::span<VertexId> ids) const override { mesh_.from_original(ids); }
  // THROWS: Error{kChanged} if the mesh has fewer triangles.
  void rewind() override;
  bool read(std::vector<VertexId>& corners, std::size_t limit) override;
  SimplexCounts simplex_counts() const override {
    return by_size_ ? SimplexCounts{0, 0, end_ - begin_} : mesh_.simplex_counts();
  }
  std::uint64_t bytes_read() const override { return (at_ - begin_) * kTriangleBytes; }
  std::uint64_t bytes_total() const override { return (end_ - begin_) * kTriangleBytes; }
  std::vector<std::string> warnings() const override { return mesh_.warnings(); }

 private:
  static constexpr std::uint64_t kTriangleBytes = 12;

  IndexedMesh& mesh_;
  std::uint64_t begin_, end_;
  bool by_size_;
  std::uint64_t at_ = 0;
  std::optional<MeshPlace> first_;  // of the triangle begin_, once it is known and if the mesh can return there
};

}  // namespace reeb::ooc
