#include "ooc/spooled_mesh.h"

#include <array>
#include <cmath>
#include <string>

#include "libreeb/base/error.h"

namespace reeb::ooc {

SpooledMesh::SpooledMesh(unsigned columns, const TempDir& temp, MemoryBudget& budget,
                         std::uint64_t allowance_bytes)
    : triangles_(temp, budget, allowance_bytes / 2) {
  columns_.reserve(columns);
  for (unsigned k = 0; k < columns; ++k)
    columns_.emplace_back(temp, budget, allowance_bytes / 2 / columns);
}

void SpooledMesh::append(const MeshBatch& batch) {
  std::vector<std::span<const double>> values;
  for (const auto& column : batch.coordinates) values.emplace_back(column);
  for (const auto& column : batch.properties) values.emplace_back(column);
  append_vertices(values);
  append_triangles(batch.triangles);
  const auto& tetrahedra = batch.tetrahedra;
  for (std::size_t t = 0; t + 4 <= tetrahedra.size(); t += 4)
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<VertexId, 3> face;
      for (std::size_t c = 0; c < 3; ++c) face[c] = tetrahedra[t + c + (c >= left_out ? 1 : 0)];
      append_triangles(face);
    }
}

void SpooledMesh::append_vertices(std::span<const std::span<const double>> values) {
  for (std::size_t k = 0; k < columns_.size() && k < values.size(); ++k)
    columns_[k].append(values[k]);
}

std::uint64_t SpooledMesh::vertex_count() const {
  return columns_.empty() ? 0 : columns_.front().size();
}

void SpooledMesh::gather(std::span<const VertexId> ids, std::span<const unsigned> columns,
                         std::span<double> values) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    VertexColumn& column = columns_[columns[k]];
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const double value = column.get(ids[i].value());
      if (!std::isfinite(value)) [[unlikely]]
        throw Error(ErrorKind::kBadInput,
                    "column " + std::to_string(columns[k]) + " is not a finite number",
                    "repair the value or choose another function")
            .at("", "vertex " + std::to_string(ids[i].value()));
      values[k * ids.size() + i] = value + 0.0;  // -0.0 becomes 0.0
    }
  }
}

std::uint64_t SpooledMesh::spilled_bytes() const {
  std::uint64_t bytes = triangles_.spilled_bytes();
  for (const VertexColumn& column : columns_) bytes += column.spilled_bytes();
  return bytes;
}

std::unique_ptr<SpooledMesh> spool(MeshReader& reader, const TempDir& temp, MemoryBudget& budget,
                                   const SpoolOptions& options) {
  std::unique_ptr<SpooledMesh> mesh;
  MeshBatch batch;
  Reservation kept = budget.reserve("mesh reader", 0);
  while (reader.read(batch)) {
    kept.resize(reader.memory_bytes());
    if (mesh == nullptr)
      mesh = std::make_unique<SpooledMesh>(
          static_cast<unsigned>(batch.coordinates.size() + batch.properties.size()), temp, budget,
          options.allowance_bytes);
    mesh->append(batch);
    if (options.progress) options.progress(reader);
  }
  if (mesh == nullptr)
    mesh = std::make_unique<SpooledMesh>(reader.info().dimension, temp, budget,
                                         options.allowance_bytes);
  return mesh;
}

}  // namespace reeb::ooc
