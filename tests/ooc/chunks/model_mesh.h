// A mesh in plain arrays that implements the ports, and meshes to store in it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::ooc {

struct ModelMesh {
  std::vector<std::vector<double>> columns;  // the first three are coordinates
  std::vector<VertexId> corners;             // three per triangle

  std::uint64_t vertex_count() const { return columns.front().size(); }
};

class ModelIndexedMesh : public IndexedMesh {
 public:
  explicit ModelIndexedMesh(const ModelMesh& mesh) : mesh_(mesh) {}

  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }
  unsigned column_count() const override { return static_cast<unsigned>(mesh_.columns.size()); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    looked_up_ += ids.size();
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t i = 0; i < ids.size(); ++i)
        values[k * ids.size() + i] = mesh_.columns[columns[k]][ids[i].value()];
  }
  SimplexCounts simplex_counts() const override { return {0, 0, mesh_.corners.size() / 3}; }
  void rewind() override { at_ = 0; }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    const std::size_t count = std::min(3 * limit, mesh_.corners.size() - at_);
    corners.assign(mesh_.corners.begin() + static_cast<std::ptrdiff_t>(at_),
                   mesh_.corners.begin() + static_cast<std::ptrdiff_t>(at_ + count));
    at_ += count;
    return count != 0;
  }
  std::optional<MeshPlace> place() const override { return MeshPlace{at_, 7}; }
  void seek(const MeshPlace& place) override { at_ = static_cast<std::size_t>(place.first); }
  std::uint64_t bytes_read() const override { return at_ * sizeof(VertexId); }
  std::uint64_t bytes_total() const override { return mesh_.corners.size() * sizeof(VertexId); }
  std::uint64_t looked_up() const { return looked_up_; }  // vertices, by gather()

 private:
  const ModelMesh& mesh_;
  std::size_t at_ = 0;
  std::uint64_t looked_up_ = 0;
};

// A grid of columns x rows vertices, triangles row by row; coordinates are exact as float32.
inline ModelMesh grid_mesh(std::uint64_t columns, std::uint64_t rows) {
  ModelMesh mesh{std::vector<std::vector<double>>(3), {}};
  for (std::uint64_t y = 0; y < rows; ++y)
    for (std::uint64_t x = 0; x < columns; ++x) {
      mesh.columns[0].push_back(static_cast<double>(x) / 4);
      mesh.columns[1].push_back(static_cast<double>(y) / 4);
      mesh.columns[2].push_back(static_cast<double>(x * 7 % 5 + y * 3 % 4));
    }
  for (std::uint64_t y = 0; y + 1 < rows; ++y)
    for (std::uint64_t x = 0; x + 1 < columns; ++x) {
      const std::uint64_t v = y * columns + x;
      for (const std::uint64_t corner : {v, v + 1, v + columns, v + 1, v + columns + 1, v + columns})
        mesh.corners.push_back(VertexId(corner));
    }
  return mesh;
}

// The same, with its last row and column joined to the first.
inline ModelMesh torus_mesh(std::uint64_t columns, std::uint64_t rows) {
  ModelMesh mesh = grid_mesh(columns, rows);
  mesh.corners.clear();
  for (std::uint64_t y = 0; y < rows; ++y)
    for (std::uint64_t x = 0; x < columns; ++x) {
      const std::uint64_t row = y * columns, row_above = (y + 1) % rows * columns, right = (x + 1) % columns;
      for (const std::uint64_t corner :
           {row + x, row + right, row_above + x, row + right, row_above + right, row_above + x})
        mesh.corners.push_back(VertexId(corner));
    }
  return mesh;
}

// A grid mesh of that many columns of vertices, with its triangles tile by tile: tiles of side x side cells, in random
// order.
inline ModelMesh in_random_tiles(const ModelMesh& mesh, std::uint64_t columns, std::uint64_t side, std::uint64_t seed) {
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<VertexId>> by_place;
  for (std::size_t t = 0; t < mesh.corners.size() / 3; ++t) {
    const std::uint64_t cell = t / 2, row = cell / (columns - 1), column = cell % (columns - 1);
    auto& tile = by_place[{row / side, column / side}];
    for (std::size_t c = 0; c < 3; ++c) tile.push_back(mesh.corners[3 * t + c]);
  }
  std::vector<std::vector<VertexId>> tiles;
  for (auto& [place, corners] : by_place) tiles.push_back(std::move(corners));
  std::mt19937_64 random(seed);
  std::shuffle(tiles.begin(), tiles.end(), random);
  ModelMesh result{mesh.columns, {}};
  for (const auto& corners : tiles) result.corners.insert(result.corners.end(), corners.begin(), corners.end());
  return result;
}

// The same surface with vertices renumbered and triangles shuffled at random.
inline ModelMesh shuffled(const ModelMesh& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::size_t> place(mesh.vertex_count()), order(mesh.corners.size() / 3);
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(place.begin(), place.end(), random);
  std::shuffle(order.begin(), order.end(), random);
  ModelMesh result = mesh;
  for (std::size_t k = 0; k < mesh.columns.size(); ++k)
    for (std::size_t v = 0; v < place.size(); ++v) result.columns[k][place[v]] = mesh.columns[k][v];
  for (std::size_t t = 0; t < order.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      result.corners[3 * t + c] = VertexId(place[mesh.corners[3 * order[t] + c].value()]);
  return result;
}

// The corners of all triangles, read `limit` triangles at a time.
inline std::vector<VertexId> all_corners(IndexedMesh& mesh, std::size_t limit) {
  std::vector<VertexId> all, some;
  mesh.rewind();
  while (mesh.read(some, limit)) {
    EXPECT_LE(some.size(), 3 * limit);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace reeb::ooc
