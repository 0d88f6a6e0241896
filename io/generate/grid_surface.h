// Surfaces made of a grid of square cells: a disc, a torus, or two sheets that are joined along the rim and connected
// by tubes. This class has the topology; a derived class places the vertices in space.
#pragma once

#include <array>

#include "io/generate/patched_grid.h"
#include "io/generate/shape.h"

namespace reeb::io {

// The holes of a closed surface: one in every complete block of 2^block_shift by 2^block_shift cells.
struct HoleLayout {
  unsigned block_shift = 2;  // REQUIRES: >= 2, so that holes touch neither each other nor the rim
  bool scattered = false;    // at pseudo-random positions in the blocks, instead of in the middle
};

struct GridLayout {
  enum class Closing {
    kDisc,       // one sheet with a boundary
    kTorus,      // one sheet, opposite sides identified. REQUIRES: width, height >= 3
    kTwoSheets,  // an upper and a lower sheet, joined along the rim, with a tube at every hole
  };
  std::uint64_t width = 1, height = 1;  // cells
  Closing closing = Closing::kDisc;
  HoleLayout holes;
  MeshOrder order = MeshOrder::kRows;
  std::uint64_t tile_cells = 32;
  std::uint64_t seed = 0;
};

// The counts in closed form, for choosing a layout before anything is built.
std::uint64_t hole_count(const GridLayout& layout);
std::uint64_t triangle_count(const GridLayout& layout);

class GridSurface : public Shape {
 public:
  explicit GridSurface(const GridLayout& layout);

  std::uint64_t cell_count() const override { return cells_.size(); }
  std::uint64_t tile_count() const override { return cells_.patch_count(); }
  std::uint64_t tile_begin(std::uint64_t tile) const override { return cells_.patch_begin(tile); }
  bool is_seam(std::uint64_t cell) const override { return cells_.is_at_seam(cells_.at(cell)); }
  ExpectedTopology topology() const override;
  void append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const override;
  void append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const override;
  void append_triangle(std::uint64_t triangle, std::vector<VertexId>& corners) const override;

 protected:
  using Point = std::array<float, 3>;
  const GridLayout& layout() const { return layout_; }

 private:
  enum Sheet : std::uint64_t { kUpper = 0, kLower = 1 };

  // The positions of the vertices at `p`: of the upper sheet, then of the lower one if there is one.
  virtual std::array<Point, 2> place(GridPoint p) const = 0;

  VertexId vertex(GridPoint p, Sheet sheet) const;
  bool is_hole(GridPoint cell) const;
  GridPoint hole_in_block(GridPoint block) const;
  std::array<GridPoint, 4> corners_of(GridPoint cell) const;
  // Triangle k of the sheets above a cell: 0, 1 of the upper, 2, 3 of the lower.
  void append_sheet_triangle(GridPoint cell, unsigned k, std::vector<VertexId>& corners) const;
  // Triangle k of the eight around the tube of a hole.
  void append_tube_triangle(GridPoint hole, unsigned k, std::vector<VertexId>& corners) const;
  // Triangle k of the two at edge `edge` of the rim; edges are numbered around the grid.
  void append_rim_triangle(std::uint64_t edge, unsigned k, std::vector<VertexId>& corners) const;
  // Triangle k of the two of an upright wall along the upper edge from p to q.
  void append_wall_triangle(GridPoint p, GridPoint q, unsigned k, std::vector<VertexId>& corners) const;
  void append_rim_of_cell(GridPoint cell, std::vector<VertexId>& corners) const;

  GridLayout layout_;
  std::uint64_t sheets_;
  PatchedGrid cells_, vertices_;
};

}  // namespace reeb::io
