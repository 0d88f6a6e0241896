// Any mesh, read once and stored in a form that can be looked up and read again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/deciding_triangles.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_numbering.h"
#include "ooc/chunks/batch_digest.h"
#include "ooc/chunks/reader_memory.h"
#include "ooc/tables/triangle_log.h"
#include "ooc/tables/vertex_column.h"

namespace reeb::ooc {

// Called with the reader after each batch.
using SpoolProgress = std::function<void(const MeshReader&)>;

struct SpoolOptions {
  std::uint64_t allowance_bytes = 32 << 20;  // of the budget, for vertices and triangles
  SpoolProgress progress = {};               // of finish()
  CellTriangles cells = CellTriangles::kDeciding;
};

// Coordinates, then the properties that the reader delivers, in one column each; triangles in a log. All are in memory
// while they fit the allowance and the budget, else in unnamed files. Where the reader leaves out vertices of a grid,
// the others are numbered 0, 1, 2, ... here; to_original() returns the numbers of the grid. MEMORY: 16 bytes a gap.
//
// THREADS: one at a time, but one may append or gather columns while another appends or reads triangles.
class SpooledMesh : public IndexedMesh {
 public:
  SpooledMesh(unsigned columns, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
              CellTriangles cells = CellTriangles::kDeciding);

  // Takes over the vertices and simplices of a batch; properties may have any values. What read() is to deliver of its
  // simplices is then batch.triangles(), and the batch has no others. REQUIRES: no triangle was read yet.
  // THROWS: Error{kBadInput} that names a vertex, if a coordinate is not finite.
  void append(MeshBatch& batch);
  // Appends vertices: values[k] is column k, all of one length.
  void append_vertices(std::span<const std::span<const double>> values);
  // The same for one column. In the end, all columns must have the same length.
  void append_column(unsigned column, std::span<const double> values) { columns_[column].append(values); }
  // REQUIRES: no triangle was read yet.
  void append_triangles(std::span<const VertexId> corners) { triangles_.append(corners); }

  std::uint64_t vertex_count() const override;
  void to_original(std::span<VertexId> ids) override;
  std::uint64_t number_count() const override { return std::max(vertex_count(), numbers_.end()); }
  void from_original(std::span<VertexId> ids) const override;
  unsigned column_count() const override { return static_cast<unsigned>(columns_.size()); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override;
  void rewind() override { triangles_.rewind(); }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override { return triangles_.read(corners, limit); }
  std::optional<MeshPlace> place() const override { return triangles_.place(); }
  void seek(const MeshPlace& place) override { triangles_.seek(place); }
  SimplexCounts simplex_counts() const override { return counts_; }
  // For triangles that were appended alone.
  void set_simplex_counts(const SimplexCounts& counts) { counts_ = counts; }
  std::uint64_t bytes_read() const override { return triangles_.bytes_read(); }
  std::uint64_t bytes_total() const override { return triangles_.bytes_total(); }

  std::uint64_t triangle_count() const { return triangles_.triangle_count(); }
  std::uint64_t spilled_bytes() const;

 private:
  void number(MeshBatch& batch);

  Reservation gap_memory_;
  VertexNumbering numbers_;
  std::vector<VertexColumn> columns_;
  TriangleLog triangles_;
  DecidingTriangles deciding_;
  SimplexCounts counts_{};
};

// Reads a mesh into that form. Finalizations are ignored.
//
// THROWS: what the reader throws; Error{kResource} of the budget or the disk.
// THREADS: one at a time.
class Spooler {
 public:
  // `reader`, `temp` and `budget` must outlive this.
  Spooler(MeshReader& reader, const io::TempDir& temp, MemoryBudget& budget, const SpoolOptions& options);

  // Takes over the next batch. False at the end, however often it is called.
  bool read();
  // What the mesh delivers of the batch that was read last: three corners per triangle.
  const std::vector<VertexId>& triangles() const { return batch_.triangles(); }
  const MeshReader& reader() const { return reader_; }
  std::uint64_t digest() const { return digest_.value(); }  // of all that was read so far
  // The mesh as far as it was read. REQUIRES: something was read.
  SpooledMesh& mesh() { return *mesh_; }

  // Reads the rest and returns the whole mesh.
  std::unique_ptr<SpooledMesh> finish();

 private:
  MeshReader& reader_;
  const io::TempDir& temp_;
  MemoryBudget& budget_;
  SpoolOptions options_;
  ReaderMemory reader_memory_;
  MeshBatch batch_;
  BatchDigest digest_;
  std::unique_ptr<SpooledMesh> mesh_;
  bool ended_ = false;
};

// Reads `reader` to its end.
std::unique_ptr<SpooledMesh> spool(MeshReader& reader, const io::TempDir& temp, MemoryBudget& budget,
                                   const SpoolOptions& options = {});

}  // namespace reeb::ooc
