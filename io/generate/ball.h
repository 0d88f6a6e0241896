// A ball of tetrahedra with straight tunnels drilled through it.
#pragma once

#include "io/generate/patched_grid.h"
#include "io/generate/shape.h"

namespace reeb::io {

// A square of size x size points, without those in square holes. The holes are in the middle of tiles, a row of tiles
// after the other. Points are numbered row by row.
class PerforatedSquare {
 public:
  struct Holes {
    std::uint64_t count = 0;            // in the first tiles
    std::uint64_t tiles = 1;            // in a row of tiles
    std::uint64_t pitch = 1;            // points along the side of a tile
    std::uint64_t lead = 0, width = 0;  // of each tile, the points lead, lead + 1, ... lead + width - 1 are a hole
  };

  PerforatedSquare(std::uint64_t size, const Holes& holes) : size_(size), holes_(holes) {}

  std::uint64_t count() const { return before_row(size_); }
  // REQUIRES: the point is in no hole.
  std::uint64_t number(GridPoint p) const { return before_row(p.j) + before_in_row(p); }
  // REQUIRES: number < count().
  GridPoint at(std::uint64_t number) const;

 private:
  // How many of the points are there before a row, and in a row before a point.
  std::uint64_t before_row(std::uint64_t row) const;
  std::uint64_t before_in_row(GridPoint p) const;
  std::uint64_t holes_before(std::uint64_t tile_row) const;
  // How many of the points 0, 1, ... before - 1 of a tile are in its hole, along one axis.
  std::uint64_t in_hole(std::uint64_t before) const;

  std::uint64_t size_;
  Holes holes_;
};

// A grid of cubes, of length x size x size, each divided into six tetrahedra along its diagonal, and rounded to a ball.
// Vertices and cubes are numbered along z last but one and x last, so the front is a plane across x, which z divides.
// A tunnel is a column of cubes that are left out, along the whole x axis; tunnels touch neither each other nor the
// surface beside their ends. So the ball is a solid body with as many handles as there are tunnels.
//
// Layers of the grid are planes z = constant, so z is divided by each tunnel: its graph has a loop for each. All
// tetrahedra are positively oriented, for any size of the grid: a layer is mapped to a disc by (x g(y), y g(x)), with
// g(t) = sqrt(1 - 0.45 t^2) and x, y from -1 to 1, and scaled. Before that, the two edges of a tetrahedron that lie in
// layers, of lengths a and b in the grid, span at least a b (g(1)^2 - g'(1)^2) > 0.
class DrilledBall : public Shape {
 public:
  // The number of tetrahedra that is nearest to `tetrahedra`, among balls that have room for the handles.
  DrilledBall(std::uint64_t tetrahedra, std::uint64_t handles);

  std::uint64_t cell_count() const override { return kTetrahedra * length_ * cubes_.count(); }
  unsigned simplex_corners() const override { return 4; }
  ExpectedTopology topology() const override;
  void append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const override;
  void append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const override;

 private:
  static constexpr std::uint64_t kTetrahedra = 6;  // of a cube

  std::uint64_t length_, size_, handles_;  // cubes along x; along y and z
  PerforatedSquare cubes_, vertices_;      // across x
};

}  // namespace reeb::io
