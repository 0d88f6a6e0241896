// A complex as input of the pipeline: as a mesh with random access, and as a stream that contains finalization.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"
#include "tests/support/inputs/complex.h"
#include "tests/support/random.h"

namespace reeb::test {

// The data of both forms. Columns 0 to 2 are the position, column 3 is the value in the complex, and further columns
// are more functions on the same vertices.
struct ComplexMesh {
  explicit ComplexMesh(const Complex& complex);
  void add_function(const std::vector<double>& values);

  std::uint64_t vertex_count() const { return columns[0].size(); }

  std::vector<std::vector<double>> columns;
  std::vector<std::vector<VertexId>> simplices;
  SimplexCounts counts{};
  // What an indexed mesh delivers of them: an edge and a vertex as degenerate triangles, and of a simplex with more
  // than three corners the triangles through its lowest one.
  std::vector<VertexId> triangles;
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

// REQUIRES: the mesh outlives it. The same holds for ComplexStream.
class IndexedComplex : public IndexedMesh {
 public:
  explicit IndexedComplex(const ComplexMesh& mesh) : mesh_(mesh) {}

  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }
  unsigned column_count() const override { return static_cast<unsigned>(mesh_.columns.size()); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override;
  SimplexCounts simplex_counts() const override { return mesh_.counts; }
  void rewind() override { at_ = 0; }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override;
  std::optional<MeshPlace> place() const override { return MeshPlace{at_, 0}; }
  void seek(const MeshPlace& place) override { at_ = static_cast<std::size_t>(place.first); }
  std::uint64_t bytes_read() const override { return at_; }
  std::uint64_t bytes_total() const override { return mesh_.triangles.size(); }

 private:
  const ComplexMesh& mesh_;
  std::size_t at_ = 0;
};

// A vertex comes when a simplex first needs it, or some time before. It is finalized when no later simplex names it, or
// some time after, or never. The seed and the size of the batches decide. A vertex of a large complex comes just when
// it is needed, and is finalized at once.
class ComplexStream : public MeshReader {
 public:
  ComplexStream(const ComplexMesh& mesh, std::uint64_t seed);

  const MeshInfo& info() const override { return info_; }
  bool read(MeshBatch& batch) override;
  std::uint64_t bytes_read() const override { return next_simplex_; }

 private:
  std::size_t simplex_count() const { return mesh_.simplices.size(); }
  void take_simplices(MeshBatch& batch);
  void take_vertices(MeshBatch& batch, std::size_t count);
  void finalize_some(MeshBatch& batch);

  const ComplexMesh& mesh_;
  Random random_;
  MeshInfo info_;
  std::size_t most_simplices_;   // per batch
  unsigned eager_percent_;       // how many of the vertices that could be finalized are finalized
  unsigned early_percent_ = 10;  // how many of the batches contain all remaining vertices
  std::vector<std::size_t> last_use_;
  std::vector<std::size_t> waiting_;  // introduced and not finalized
  std::size_t next_simplex_ = 0, next_vertex_ = 0;
};

// The same without finalization.
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
