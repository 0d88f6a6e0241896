// A mesh as a function of indices: what each kind of generated mesh provides.
#pragma once

#include <cstdint>
#include <vector>

#include "io/generate/generator.h"

namespace reeb::io {

// Triangles are grouped into cells. The cells 0, 1, ... give the mesh in its coherent order; for other orders, each
// triangle can be computed by its index.
class Shape {
 public:
  using Columns = std::vector<std::vector<double>>;

  Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;
  virtual ~Shape() = default;

  virtual unsigned dimension() const { return 3; }
  virtual std::uint64_t cell_count() const = 0;
  // The number of corners of each cell, if a cell is one simplex that is delivered as it is; else 0.
  virtual unsigned simplex_corners() const { return 0; }
  // Consecutive cells form tiles. Tile t begins with cell tile_begin(t), and the last one ends at tile_begin(tiles).
  virtual std::uint64_t tile_count() const { return 1; }
  virtual std::uint64_t tile_begin(std::uint64_t tile) const { return tile == 0 ? 0 : cell_count(); }
  // Whether a cell joins its tile to a later one.
  virtual bool is_seam([[maybe_unused]] std::uint64_t cell) const { return false; }
  virtual ExpectedTopology topology() const = 0;

  // Appends the coordinates of vertices first, first + 1, ... first + count - 1 to `columns`.
  virtual void append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const = 0;
  // Appends the corners of a cell that is one simplex, or of all its triangles, consistently oriented on orientable
  // surfaces.
  virtual void append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const = 0;
  // Appends the corners of one triangle. REQUIRES: triangle < topology().triangles; simplex_corners() is 0.
  virtual void append_triangle([[maybe_unused]] std::uint64_t triangle,
                               [[maybe_unused]] std::vector<VertexId>& corners) const {}
};

}  // namespace reeb::io
