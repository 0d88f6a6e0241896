#include "libreeb/grid/grid_division.h"

namespace reeb {
namespace {

bool is_within(unsigned set, unsigned other) { return (set & ~other) == 0; }

void extend(const GridSimplex& simplex, std::uint8_t axes, std::size_t least_corners, std::vector<GridSimplex>& all) {
  if (simplex.corner_count >= least_corners) all.push_back(simplex);
  for (unsigned next = 1; next <= axes; ++next) {
    if (!is_within(next, axes) || !is_within(simplex.top(), next) || next == simplex.top()) continue;
    GridSimplex larger = simplex;
    larger.corners[larger.corner_count++] = static_cast<std::uint8_t>(next);
    extend(larger, axes, least_corners, all);
  }
}

}  // namespace

std::vector<GridSimplex> grid_simplices(std::uint8_t axes, std::size_t least_corners) {
  std::vector<GridSimplex> all;
  extend({}, axes, least_corners, all);
  return all;
}

// A further corner is between two corners or beyond the last one; or it is the lowest corner of the larger simplex.
std::vector<GridStep> steps_to_cofaces(const GridSimplex& simplex, std::uint8_t axes) {
  std::vector<GridStep> steps;
  for (unsigned set = 1; set <= axes; ++set) {
    if (!is_within(set, axes)) continue;
    bool fits = true;
    for (unsigned c = 0; c < simplex.corner_count; ++c) {
      const unsigned corner = simplex.corners[c];
      fits &= set != corner && (is_within(set, corner) || is_within(corner, set));
    }
    if (fits) steps.push_back({static_cast<std::uint8_t>(set), 0});
    if ((set & simplex.top()) == 0) steps.push_back({0, static_cast<std::uint8_t>(set)});
  }
  return steps;
}

}  // namespace reeb
