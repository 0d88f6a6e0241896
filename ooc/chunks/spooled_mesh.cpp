#include "ooc/chunks/spooled_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

// Readers of files have checked them; others may not.
void check_coordinates(const MeshBatch& batch) {
  for (const auto& column : batch.coordinates) {
    const auto non_finite = std::ranges::find_if(column, [](double value) { return !std::isfinite(value); });
    if (non_finite == column.end()) continue;
    const auto vertex = batch.first_vertex.value() + static_cast<std::uint64_t>(non_finite - column.begin());
    throw Error(ErrorKind::kBadInput, "a coordinate is not finite", "fix this vertex, or remove it")
        .at("", "vertex " + std::to_string(vertex));
  }
}

}  // namespace

SpooledMesh::SpooledMesh(unsigned columns, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
                         CellTriangles cells)
    : gap_memory_(budget.reserve("gaps of a grid", 0)),
      triangles_(temp, budget, allowance_bytes / 2),
      deciding_(cells) {
  columns_.reserve(columns);
  for (unsigned k = 0; k < columns; ++k) columns_.emplace_back(temp, budget, allowance_bytes / 2 / columns);
}

// Notes the numbers of the new vertices, and replaces them by indices in the simplices.
void SpooledMesh::number(MeshBatch& batch) {
  numbers_.append(batch.first_vertex.value(), batch.vertex_count);
  if (!numbers_.has_gaps()) return;
  gap_memory_.resize(numbers_.memory_bytes());
  for (auto& corners : batch.simplices) {
    from_original(corners);
    if (std::ranges::find(corners, VertexId::none()) != corners.end()) throw input_changed();
  }
}

void SpooledMesh::to_original(std::span<VertexId> ids) {
  if (!numbers_.has_gaps()) return;
  for (VertexId& id : ids) id = VertexId(numbers_.number_of(id.value()));
}

void SpooledMesh::from_original(std::span<VertexId> ids) const {
  if (!numbers_.has_gaps()) return IndexedMesh::from_original(ids);
  for (VertexId& id : ids) {
    const auto index = numbers_.index_of(id.value());
    id = index ? VertexId(*index) : VertexId::none();
  }
}

void SpooledMesh::append(MeshBatch& batch) {
  check_coordinates(batch);
  number(batch);
  std::vector<std::span<const double>> values;
  for (const auto& column : batch.coordinates) values.emplace_back(column);
  for (const auto& column : batch.properties) values.emplace_back(column);
  append_vertices(values);
  batch.add_counts(counts_);
  deciding_.reduce(batch);
  append_triangles(batch.triangles());
}

void SpooledMesh::append_vertices(std::span<const std::span<const double>> values) {
  for (std::size_t k = 0; k < columns_.size() && k < values.size(); ++k) columns_[k].append(values[k]);
}

std::uint64_t SpooledMesh::vertex_count() const { return columns_.empty() ? 0 : columns_.front().size(); }

void SpooledMesh::gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    VertexColumn& column = columns_[columns[k]];
    for (std::size_t i = 0; i < ids.size(); ++i)
      values[k * ids.size() + i] = column.get(ids[i].value()) + 0.0;  // -0.0 becomes 0.0
  }
}

std::uint64_t SpooledMesh::spilled_bytes() const {
  std::uint64_t bytes = triangles_.spilled_bytes();
  for (const VertexColumn& column : columns_) bytes += column.spilled_bytes();
  return bytes;
}

Spooler::Spooler(MeshReader& reader, const io::TempDir& temp, MemoryBudget& budget, const SpoolOptions& options)
    : reader_(reader), temp_(temp), budget_(budget), options_(options), reader_memory_(budget) {}

bool Spooler::read() {
  if (ended_) return false;
  const bool some = reader_.read(batch_);
  ended_ = !some;
  if (mesh_ == nullptr) {
    const std::size_t columns = some ? batch_.coordinates.size() + batch_.properties.size() : reader_.info().dimension;
    mesh_ = std::make_unique<SpooledMesh>(static_cast<unsigned>(columns), temp_, budget_, options_.allowance_bytes,
                                          options_.cells);
  }
  if (!some) return false;
  digest_.add(batch_);
  reader_memory_.update(reader_);
  mesh_->append(batch_);
  return true;
}

std::unique_ptr<SpooledMesh> Spooler::finish() {
  while (read())
    if (options_.progress) options_.progress(reader_);
  return std::move(mesh_);
}

std::unique_ptr<SpooledMesh> spool(MeshReader& reader, const io::TempDir& temp, MemoryBudget& budget,
                                   const SpoolOptions& options) {
  return Spooler(reader, temp, budget, options).finish();
}

}  // namespace reeb::ooc
