// The division of a grid into simplices (docs/SEMANTICS.md, Grids).
//
// Each cube is divided into the six tetrahedra that contain the diagonal from its lowest to its highest corner, one for
// each order of the axes; squares and edges in the same way. So the corners of a simplex, seen from the lowest one, are
// a chain of sets of axes, each within the next. Any two simplices of neighbouring cubes agree on what they share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace reeb {

// A simplex at its lowest corner. Corner c is one step from there along each of the axes in the set `corners[c]`, of
// which bit k stands for axis k; corners[0] is the empty set.
struct GridSimplex {
  std::uint8_t corner_count = 1;
  std::array<std::uint8_t, 4> corners{};

  std::uint8_t top() const { return corners[corner_count - 1u]; }
};

// All simplices with at least `least_corners` corners, where only `axes` have more than one vertex.
std::vector<GridSimplex> grid_simplices(std::uint8_t axes, std::size_t least_corners);

// Where a further vertex would have to be for a simplex to be a face of a larger one: at the lowest corner, a step up
// along each axis in `up` and a step down along each in `down`.
struct GridStep {
  std::uint8_t up = 0, down = 0;
};
std::vector<GridStep> steps_to_cofaces(const GridSimplex& simplex, std::uint8_t axes);

}  // namespace reeb
