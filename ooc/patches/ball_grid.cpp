#include "ooc/patches/ball_grid.h"

#include <algorithm>
#include <cmath>

namespace reeb::ooc {
namespace {

// Cells that are far from each other may share a key; then a question looks at more balls.
std::uint64_t cell_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  return (static_cast<std::uint64_t>(x) & kMask) | (static_cast<std::uint64_t>(y) & kMask) << 21 |
         (static_cast<std::uint64_t>(z) & kMask) << 42;
}

std::int64_t cell_of(double coordinate, int exponent) {
  return static_cast<std::int64_t>(std::floor(std::clamp(std::ldexp(coordinate, -exponent), -0x1p60, 0x1p60)));
}

}  // namespace

BallGrid::BallGrid(std::span<const Ball> balls) : balls_(balls.begin(), balls.end()) {
  for (std::uint32_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    if (!(ball.radius > 0) || !std::isfinite(ball.radius)) continue;
    const int exponent = std::ilogb(ball.radius) + 2;  // a cell is two to four radii wide
    auto grid = std::ranges::find(grids_, exponent, &Grid::exponent);
    if (grid == grids_.end()) grid = grids_.insert(grids_.end(), {exponent, {}});
    std::array<std::array<std::int64_t, 2>, 3> range{};
    for (std::size_t k = 0; k < 3; ++k)
      range[k] = {cell_of(ball.center[k] - ball.radius, exponent), cell_of(ball.center[k] + ball.radius, exponent)};
    for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z)
      for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y)
        for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x) {
          const auto entry = static_cast<std::uint32_t>(entries_.size());
          const std::uint32_t first = grid->first.find_or_insert(cell_key(x, y, z), entry);
          if (first == entry) {
            entries_.push_back({i, FlatMap::kNone});
          } else {
            entries_.push_back({i, entries_[first].next});
            entries_[first].next = entry;
          }
        }
  }
}

std::uint32_t BallGrid::find(const Point& point) const {
  for (const Grid& grid : grids_) {
    std::uint32_t entry = grid.first.find(
        cell_key(cell_of(point[0], grid.exponent), cell_of(point[1], grid.exponent), cell_of(point[2], grid.exponent)));
    for (; entry != FlatMap::kNone; entry = entries_[entry].next)
      if (balls_[entries_[entry].ball].contains(point)) return entries_[entry].ball;
  }
  return kNone;
}

}  // namespace reeb::ooc
