#include "ooc/patches/near_balls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libreeb/defects/surface_patch.h"

namespace reeb::ooc {
namespace {

std::int64_t cell_of(double coordinate, int exponent) {
  return static_cast<std::int64_t>(std::floor(std::clamp(std::ldexp(coordinate, -exponent), -0x1p60, 0x1p60)));
}

// A cell is one to two radii wide. Balls without extent have the finest one.
int grid_exponent(const Ball& ball) {
  constexpr int kFinest = -1000;
  return ball.radius > 0 ? std::ilogb(ball.radius) + 1 : kFinest;
}

// Cells that are far from each other may share a key; then a question looks at more balls.
std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  return (static_cast<std::uint64_t>(x) & kMask) | (static_cast<std::uint64_t>(y) & kMask) << 21 |
         (static_cast<std::uint64_t>(z) & kMask) << 42;
}

}  // namespace

void NearBalls::add(const Ball& ball, std::uint32_t number) {
  const int exponent = grid_exponent(ball);
  auto grid = std::ranges::find(grids_, exponent, &Grid::exponent);
  if (grid == grids_.end()) grid = grids_.insert(grids_.end(), {exponent, {}});
  const std::uint64_t key =
      key_of(cell_of(ball.center[0], exponent), cell_of(ball.center[1], exponent), cell_of(ball.center[2], exponent));
  const auto entry = static_cast<std::uint32_t>(entries_.size());
  const std::uint32_t first = grid->first.find_or_insert(key, entry);
  entries_.push_back({ball, number, kNone});
  if (first == entry) return;
  entries_[entry].next = entries_[first].next;
  entries_[first].next = entry;
}

std::vector<std::uint32_t> NearBalls::meeting(const Ball& ball) const {
  std::vector<std::uint32_t> result;
  const auto look_at = [&](const Entry& entry) {
    if (distance(entry.ball.center, ball.center) <= entry.ball.radius + ball.radius) result.push_back(entry.number);
  };
  for (const Grid& grid : grids_) {
    const double reach = ball.radius + std::ldexp(1, grid.exponent);
    // Among balls far smaller than this one: all of them.
    if (std::ldexp(reach, -grid.exponent) > 8) {
      for (const Entry& entry : entries_)
        if (grid_exponent(entry.ball) == grid.exponent) look_at(entry);
      continue;
    }
    std::array<std::array<std::int64_t, 2>, 3> range{};
    for (std::size_t k = 0; k < 3; ++k)
      range[k] = {cell_of(ball.center[k] - reach, grid.exponent), cell_of(ball.center[k] + reach, grid.exponent)};
    for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z)
      for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y)
        for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x)
          for (std::uint32_t i = grid.first.find(key_of(x, y, z)); i != kNone; i = entries_[i].next)
            look_at(entries_[i]);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace reeb::ooc
