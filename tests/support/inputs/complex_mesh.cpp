#include "tests/support/inputs/complex_mesh.h"

#include <algorithm>

namespace reeb::test {
namespace {

void append_triangles(const std::vector<VertexId>& simplex, std::vector<VertexId>& triangles) {
  const std::size_t n = simplex.size();
  if (n <= 3) {
    for (const std::size_t corner : {0u, 1u, 2u}) triangles.push_back(simplex[std::min(corner, n - 1)]);
    return;
  }
  const VertexId lowest = *std::min_element(simplex.begin(), simplex.end());
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a; b < n; ++b)  // repeated corners leave an edge
      if (simplex[a] != lowest && simplex[b] != lowest)
        triangles.insert(triangles.end(), {simplex[b], lowest, simplex[a]});
}

// The ports require that there is no -0.0.
double plain(double value) { return value + 0.0; }

}  // namespace

ComplexMesh::ComplexMesh(const Complex& complex) : columns(3) {
  for (std::size_t k = 0; k < 3; ++k)
    for (const auto& position : complex.positions) columns[k].push_back(plain(position[k]));
  add_function(complex.values);
  for (const auto& corners : complex.simplices) {
    std::vector<VertexId>& simplex = simplices.emplace_back();
    for (const std::uint64_t corner : corners) simplex.emplace_back(corner);
    append_triangles(simplex, triangles);
    ++counts.at(simplex.size() - 1);
  }
}

void ComplexMesh::add_function(const std::vector<double>& values) {
  columns.emplace_back(values.size());
  std::transform(values.begin(), values.end(), columns.back().begin(), plain);
}

void ColumnFunction::evaluate(std::span<const VertexId>, std::span<const std::span<const double>> columns,
                              std::span<double> values) {
  std::copy(columns[0].begin(), columns[0].end(), values.begin());
}

void IndexedComplex::gather(std::span<const VertexId> ids, std::span<const unsigned> columns,
                            std::span<double> values) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t i = 0; i < ids.size(); ++i) values[k * ids.size() + i] = mesh_.columns[columns[k]][ids[i].value()];
}

bool IndexedComplex::read(std::vector<VertexId>& corners, std::size_t limit) {
  const std::size_t end = at_ + std::min(3 * limit, mesh_.triangles.size() - at_);
  corners.assign(mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(at_),
                 mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(end));
  at_ = end;
  return !corners.empty();
}

ComplexStream::ComplexStream(const ComplexMesh& mesh, std::uint64_t seed)
    : mesh_(mesh), random_(seed), last_use_(mesh.vertex_count(), 0) {
  constexpr std::size_t kBatches[] = {1, 3, 4096};
  most_simplices_ = kBatches[random_.below(std::size(kBatches))];
  eager_percent_ = random_.chance(50) ? 100 : 40;
  // The path of an edge becomes long if its ends stay incomplete for long. So in a large mesh, a vertex comes when it
  // is needed, and is finalized at once.
  if (simplex_count() > 10'000) {
    most_simplices_ = 4096;
    eager_percent_ = 100;
    early_percent_ = 0;
  }
  info_.format = "complex";
  info_.finalizes = true;
  for (std::size_t i = 0; i < simplex_count(); ++i)
    for (const VertexId v : mesh.simplices[i]) last_use_[v.value()] = i;
}

bool ComplexStream::read(MeshBatch& batch) {
  batch.clear();
  batch.coordinates.resize(3);
  batch.properties.resize(mesh_.columns.size() - 3);
  batch.first_vertex = VertexId(next_vertex_);
  take_simplices(batch);
  if (next_simplex_ == simplex_count() || random_.chance(early_percent_)) take_vertices(batch, mesh_.vertex_count());
  finalize_some(batch);
  return !batch.empty();
}

void ComplexStream::take_simplices(MeshBatch& batch) {
  const std::size_t end = std::min(next_simplex_ + most_simplices_, simplex_count());
  for (; next_simplex_ < end; ++next_simplex_) {
    const std::vector<VertexId>& corners = mesh_.simplices[next_simplex_];
    take_vertices(batch, static_cast<std::size_t>(std::max_element(corners.begin(), corners.end())->value()) + 1);
    auto& batch_corners = batch.simplices[corners.size() - 1];
    batch_corners.insert(batch_corners.end(), corners.begin(), corners.end());
  }
}

void ComplexStream::take_vertices(MeshBatch& batch, std::size_t count) {
  for (; next_vertex_ < count; ++next_vertex_) {
    for (std::size_t k = 0; k < mesh_.columns.size(); ++k) batch.column(k).push_back(mesh_.columns[k][next_vertex_]);
    ++batch.vertex_count;
    waiting_.push_back(next_vertex_);
  }
}

void ComplexStream::finalize_some(MeshBatch& batch) {
  std::erase_if(waiting_, [&](std::size_t v) {
    if (last_use_[v] >= next_simplex_ && next_simplex_ < simplex_count()) return false;
    if (!random_.chance(eager_percent_)) return false;
    batch.finalized.push_back(VertexId(v));
    return true;
  });
}

}  // namespace reeb::test
