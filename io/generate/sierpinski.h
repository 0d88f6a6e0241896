// The Sierpinski simplex, or its 2-skeleton: simplices that touch at corners only, full of loops.
#pragma once

#include <array>

#include "io/generate/shape.h"

namespace reeb::io {

// Level 0 is one d-simplex. Each level replaces every simplex of the level before by d + 1 simplices of half the size,
// one in each corner. A cell is a simplex of the last level. Its number is its address: the corners chosen from level
// to level, the first as the most significant digit.
//
// A divided simplex owns the midpoints of its edges. Simplices are numbered in preorder, so that vertices are near the
// cells that use them. All coordinates are integers.
class SierpinskiSimplex : public Shape {
 public:
  static constexpr unsigned kMinDimension = 2, kMaxDimension = 5;

  // Chooses the level with the number of triangles nearest to `triangles`. REQUIRES: a dimension within the limits.
  SierpinskiSimplex(unsigned dimension, std::uint64_t triangles, bool whole_cells);

  unsigned dimension() const override;
  std::uint64_t cell_count() const override { return cells_; }
  unsigned simplex_corners() const override { return whole_cells_ ? corners_ : 0; }
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
  bool whole_cells_;
  unsigned levels_ = 0;
  std::uint64_t cells_ = 1;
  // By depth: the number of divided simplices in the subtree of a simplex, itself included.
  std::array<std::uint64_t, kMaxLevels + 1> divided_{};
};

}  // namespace reeb::io
