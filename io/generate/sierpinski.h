// The 2-skeleton of the Sierpinski simplex: simplices that touch at corners only, full of loops.
#pragma once

#include <array>

#include "io/generate/shape.h"

namespace reeb::io {

// Level 0 is one d-simplex; each further level replaces a simplex by d + 1 of half the size, one in
// each of its corners. A cell is a simplex of the last level, named by its address: the corners
// chosen on the way down, first choice most significant.
//
// A simplex that is divided owns the midpoints of its edges; simplices are numbered in preorder, so
// that vertices are near the cells that use them. All coordinates are integers.
class SierpinskiSimplex : public Shape {
 public:
  static constexpr unsigned kMinDimension = 2, kMaxDimension = 5;

  // The level whose triangles come nearest to `triangles`. REQUIRES: a dimension within the limits.
  SierpinskiSimplex(unsigned dimension, std::uint64_t triangles);

  unsigned dimension() const override;
  std::uint64_t cell_count() const override { return cells_; }
  ExpectedTopology topology() const override;
  void append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const override;
  void append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const override;
  void append_triangle(std::uint64_t triangle, std::vector<VertexId>& corners) const override;

 private:
  static constexpr unsigned kMaxLevels = 64, kMaxCorners = kMaxDimension + 1;

  using Position = std::array<std::uint64_t, kMaxDimension>;

  Position position(std::uint64_t vertex) const;
  void add_corner(Position& sum, unsigned corner, std::uint64_t length) const;
  // The vertices at the corners of a cell.
  std::array<VertexId, kMaxCorners> corners_of(std::uint64_t cell) const;

  unsigned dimension_, corners_, edges_, faces_;  // of a simplex
  unsigned levels_ = 0;
  std::uint64_t cells_ = 1;
  // How many simplices are divided in the subtree of one at this depth, itself included.
  std::array<std::uint64_t, kMaxLevels + 1> divided_{};
};

}  // namespace reeb::io
