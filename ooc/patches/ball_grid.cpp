#include "ooc/patches/ball_grid.h"

#include <bit>
#include <cmath>

namespace reeb::ooc {
namespace {

bool has_inside(const Ball& ball) { return ball.radius > 0 && std::isfinite(ball.radius); }

// A cell is two to four radii wide.
int exponent_of(const Ball& ball) { return std::max(std::ilogb(ball.radius) + 2, -1000); }

}  // namespace

template <class Visit>
void BallGrid::for_each_cell(const Ball& ball, const Visit& visit) const {
  if (!has_inside(ball)) return;
  const Grid& grid = *std::ranges::find(grids_, exponent_of(ball), &Grid::exponent);
  std::array<std::array<std::int64_t, 2>, 3> range{};
  for (std::size_t k = 0; k < 3; ++k)
    range[k] = {cell_of(grid, ball.center[k] - ball.radius), cell_of(grid, ball.center[k] + ball.radius)};
  for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z)
    for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y)
      for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x) visit(slot_of(grid, {x, y, z}));
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
  for (const Ball& ball : balls_) for_each_cell(ball, [&](std::size_t slot) { ++first_[slot]; });
  std::uint32_t end = 0;
  for (std::uint32_t& first : first_) first = end += first;
  entries_.resize(end);
  // From the last to the first: those of each slot ascend.
  for (auto i = static_cast<std::uint32_t>(balls_.size()); i-- > 0;)
    for_each_cell(balls_[i], [&](std::size_t slot) { entries_[--first_[slot]] = i; });
}

}  // namespace reeb::ooc
