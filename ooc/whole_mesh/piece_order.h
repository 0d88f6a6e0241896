// The order in which the pieces of a mesh are visited, and the mesh in that order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "ooc/whole_mesh/mesh_pieces.h"

namespace reeb::ooc {

// Sorts pieces into cells of space with some ten thousand triangles each, which are larger than an average piece by the
// same factor along each axis; cells in slabs across the axis that has most of them, to and fro within a slab. So what
// was visited ends near a plane, which keeps the front short, and consecutive pieces are neighbours. The pieces of a
// cell are sorted in the same way, by small cells with a piece or two each. TIME: O(n log n).   MEMORY: 8 bytes per
// piece meanwhile.
void order_pieces(MeshPieces& pieces);

// A mesh with its triangles piece by piece, read from the mesh itself. Vertices keep their indices.
class PiecewiseMesh : public IndexedMesh {
 public:
  // In the order of `pieces`, which are all pieces of the mesh. REQUIRES: the mesh was read to its end.
  PiecewiseMesh(std::unique_ptr<IndexedMesh> mesh, MeshPieces pieces);

  // The mesh as it was. Nothing else may be called afterwards.
  std::unique_ptr<IndexedMesh> release() { return std::move(mesh_); }
  std::uint64_t memory_bytes() const { return pieces_.memory.bytes(); }

  std::uint64_t vertex_count() const override { return mesh_->vertex_count(); }
  unsigned column_count() const override { return mesh_->column_count(); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    mesh_->gather(ids, columns, values);
  }
  void to_original(std::span<VertexId> ids) override { mesh_->to_original(ids); }
  std::uint64_t number_count() const override { return mesh_->number_count(); }
  void from_original(std::span<VertexId> ids) const override { mesh_->from_original(ids); }
  SimplexCounts simplex_counts() const override { return counts_; }
  void rewind() override;
  bool read(std::vector<VertexId>& corners, std::size_t limit) override;
  std::uint64_t bytes_read() const override;
  std::uint64_t bytes_total() const override { return mesh_->bytes_total(); }
  std::vector<std::string> warnings() const override { return pieces_.warnings; }

 private:
  std::unique_ptr<IndexedMesh> mesh_;
  MeshPieces pieces_;
  SimplexCounts counts_;
  std::uint64_t triangle_count_ = 0, triangles_read_ = 0;
  std::size_t next_ = 0;  // piece
  std::size_t left_ = 0;  // triangles of the piece before it
  std::vector<VertexId> more_;
};

}  // namespace reeb::ooc
