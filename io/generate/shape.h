// A mesh as a function of indices: what a kind of generated mesh has to supply.
#pragma once

#include <cstdint>
#include <vector>

#include "io/generate/generator.h"

namespace reeb::io {

// Triangles come in cells. Walking the cells 0, 1, ... gives the mesh in its coherent order;
// single triangles can be had by index for any other.
class Shape {
 public:
  using Columns = std::vector<std::vector<double>>;

  Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;
  virtual ~Shape() = default;

  virtual unsigned dimension() const { return 3; }
  virtual std::uint64_t cell_count() const = 0;
  virtual ExpectedTopology topology() const = 0;

  // Appends the coordinates of vertices first, first + 1, ... first + count - 1 to `columns`.
  virtual void append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const = 0;
  // Appends the corners of all triangles of a cell; consistently oriented on orientable surfaces.
  virtual void append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const = 0;
  // Appends the corners of one triangle; every triangle has one index below topology().triangles.
  virtual void append_triangle(std::uint64_t triangle, std::vector<VertexId>& corners) const = 0;
};

}  // namespace reeb::io
