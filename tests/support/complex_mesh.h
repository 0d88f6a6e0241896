// A complex behind the ports of the pipeline: as a mesh with random access, and as a stream that
// brings its finalization with it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"
#include "tests/support/complex.h"
#include "tests/support/random.h"

namespace reeb::test {

// What both forms deliver: columns 0 to 2 are the position, column 3 is the complex's value, those
// after it are more functions on the same vertices.
struct ComplexMesh {
  explicit ComplexMesh(const Complex& complex);
  void add_function(const std::vector<double>& values);

  std::uint64_t vertex_count() const { return columns[0].size(); }

  std::vector<std::vector<double>> columns;
  // All triangles of a simplex, three corners each; an edge and a vertex as degenerate ones.
  std::vector<VertexId> triangles;
  // triangle_begin[i]: the first corner in `triangles` of simplex i; one more entry than simplices.
  std::vector<std::size_t> triangle_begin;
  // The corners of simplex i if it has four, for which a stream has a form of its own.
  std::vector<std::array<VertexId, 4>> tetrahedra;
  std::vector<bool> is_tetrahedron;  // one a simplex
};

// The function that is one column of a ComplexMesh.
class ColumnFunction : public VertexFunction {
 public:
  explicit ColumnFunction(unsigned column) : column_{column} {}
  std::string name() const override { return std::string("c") += std::to_string(column_[0]); }
  std::span<const unsigned> columns() const override { return column_; }
  void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> columns,
                std::span<double> values) override;

 private:
  std::array<unsigned, 1> column_;
};

// REQUIRES: the mesh outlives it; so for ComplexStream.
class IndexedComplex : public IndexedMesh {
 public:
  explicit IndexedComplex(const ComplexMesh& mesh) : mesh_(mesh) {}

  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }
  unsigned column_count() const override { return static_cast<unsigned>(mesh_.columns.size()); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override;
  void rewind() override { at_ = 0; }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override;
  std::uint64_t bytes_read() const override { return at_; }
  std::uint64_t bytes_total() const override { return mesh_.triangles.size(); }

 private:
  const ComplexMesh& mesh_;
  std::size_t at_ = 0;
};

// A vertex comes when a simplex first needs it or some time before, and is finalized when no later
// simplex names it, or some time after, or never: the seed decides, and the size of the batches.
// A vertex of a large complex comes just when it is needed and is finalized at once.
class ComplexStream : public MeshReader {
 public:
  ComplexStream(const ComplexMesh& mesh, std::uint64_t seed);

  const MeshInfo& info() const override { return info_; }
  bool read(MeshBatch& batch) override;
  std::uint64_t bytes_read() const override { return next_simplex_; }

 private:
  std::size_t simplex_count() const { return mesh_.triangle_begin.size() - 1; }
  void take_simplices(MeshBatch& batch);
  void take_vertices(MeshBatch& batch, std::size_t count);
  void finalize_some(MeshBatch& batch);

  const ComplexMesh& mesh_;
  Random random_;
  MeshInfo info_;
  std::size_t most_simplices_;   // a batch
  unsigned eager_percent_;       // of the vertices that could be finalized, how many are
  unsigned early_percent_ = 10;  // of the batches, how many bring all vertices
  std::vector<std::size_t> last_use_;
  std::vector<std::size_t> waiting_;  // introduced and not finalized
  std::size_t next_simplex_ = 0, next_tetrahedron_ = 0, next_vertex_ = 0;
};

// The same without a word about finalization.
class UnfinalizedComplex : public MeshReader {
 public:
  UnfinalizedComplex(const ComplexMesh& mesh, std::uint64_t seed) : stream_(mesh, seed), info_(stream_.info()) {
    info_.finalizes = false;
  }

  const MeshInfo& info() const override { return info_; }
  bool read(MeshBatch& batch) override {
    const bool some = stream_.read(batch);
    batch.finalized.clear();
    return some;
  }
  std::uint64_t bytes_read() const override { return stream_.bytes_read(); }

 private:
  ComplexStream stream_;
  MeshInfo info_;
};

}  // namespace reeb::test
