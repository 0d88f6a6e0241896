// Cells of a grid in space.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "libreeb/graph/settled_node.h"

namespace reeb::ooc {

using SpaceCell = std::array<std::int64_t, 3>;

// The cell of a coordinate. What is farther than 2^60 cells from the origin shares the last cell.
inline std::int64_t cell_of(double coordinate, double cells_per_unit) {
  const double place = std::min(std::max(-0x1p60, coordinate * cells_per_unit), 0x1p60);
  const auto cell = static_cast<std::int64_t>(place);
  return cell - (static_cast<double>(cell) > place ? 1 : 0);
}

inline SpaceCell cell_at(const Point& point, double cells_per_unit) {
  return {cell_of(point[0], cells_per_unit), cell_of(point[1], cells_per_unit), cell_of(point[2], cells_per_unit)};
}

// Calls visit(cell) for each cell that is not farther than `reach` from the point, along each axis.
template <class Visit>
void for_each_cell(const Point& center, double reach, double cells_per_unit, const Visit& visit) {
  std::array<std::array<std::int64_t, 2>, 3> range{};
  for (std::size_t k = 0; k < 3; ++k)
    range[k] = {cell_of(center[k] - reach, cells_per_unit), cell_of(center[k] + reach, cells_per_unit)};
  for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z)
    for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y)
      for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x) visit(SpaceCell{x, y, z});
}

}  // namespace reeb::ooc
