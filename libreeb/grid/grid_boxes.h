// The boxes into which a grid is cut. Neighbours have their common face, edge or corner both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "libreeb/sweep/chunk.h"

namespace reeb {

// Vertices along each axis of a grid, none of them 0; vertex (i, j, k) has the index i + size[0] * (j + size[1] * k).
using GridSize = std::array<std::uint64_t, 3>;

// Boxes come in the order of (k, j, i): layer by layer, and row by row within a layer.
class GridBoxes {
 public:
  // `cells`: of a box along each axis, at least 1; the last box along an axis can have fewer.
  GridBoxes(const GridSize& grid, const std::array<std::uint32_t, 3>& cells) : grid_(grid), cells_(cells) {}

  // How many boxes there are along an axis; at least 1.
  std::uint64_t count(std::size_t axis) const { return grid_[axis] <= 2 ? 1 : (grid_[axis] - 2) / cells_[axis] + 1; }
  std::uint64_t first(std::size_t axis, std::uint64_t box) const { return box * cells_[axis]; }
  std::uint32_t size(std::size_t axis, std::uint64_t box) const {
    const std::uint64_t first_vertex = first(axis, box), rest = grid_[axis] - first_vertex;
    return rest <= cells_[axis] ? static_cast<std::uint32_t>(rest) : cells_[axis] + 1;
  }
  // The faces of a box that other boxes have, too.
  BoxFaces shared_faces(const std::array<std::uint64_t, 3>& box) const;
  // Replaces `chunk` by a box, without positions.
  void fill(const std::array<std::uint64_t, 3>& box, Chunk& chunk) const;

 private:
  GridSize grid_;
  std::array<std::uint32_t, 3> cells_;
};

}  // namespace reeb
