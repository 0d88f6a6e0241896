#include "ooc/patches/ball_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace reeb::ooc {
namespace {

bool has_inside(const Ball& ball) { return ball.radius > 0 && std::isfinite(ball.radius); }

// A cell is two to four radii wide.
int exponent_of(const Ball& ball) { return std::max(std::ilogb(ball.radius) + 2, -1000); }

}  // namespace

template <class Visit>
void BallGrid::for_each_slot(const Ball& ball, const Visit& visit) const {
  if (!has_inside(ball)) return;
  const Grid& grid = *std::ranges::find(grids_, exponent_of(ball), &Grid::exponent);
  for_each_cell(ball.center, ball.radius, grid.cells_per_unit,
                [&](const SpaceCell& cell) { visit(slot_of(grid, cell)); });
}

BallGrid::BallGrid(std::span<const Ball> balls) : balls_(balls.begin(), balls.end()) {
  for (const Ball& ball : balls_) {
    if (!has_inside(ball)) continue;
    const int exponent = exponent_of(ball);
    if (std::ranges::find(grids_, exponent, &Grid::exponent) == grids_.end())
      grids_.push_back({exponent, std::ldexp(1, -exponent)});
  }
  // Most questions are about points in no ball: most slots are empty.
  mask_ = std::bit_ceil(8 * balls_.size() + 1) - 1;
  first_.assign(mask_ + 2, 0);
  for (const Ball& ball : balls_) for_each_slot(ball, [&](std::size_t slot) { ++first_[slot]; });
  std::uint32_t end = 0;
  for (std::uint32_t& first : first_) first = end += first;
  entries_.resize(end);
  // From the last to the first: those of each slot ascend.
  for (auto i = static_cast<std::uint32_t>(balls_.size()); i-- > 0;)
    for_each_slot(balls_[i], [&](std::size_t slot) { entries_[--first_[slot]] = i; });
}

}  // namespace reeb::ooc
