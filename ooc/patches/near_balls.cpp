#include "ooc/patches/near_balls.h"

#include <algorithm>
#include <cmath>

#include "libreeb/base/vector3.h"
#include "ooc/patches/space_cells.h"

namespace reeb::ooc {
namespace {

// A cell is one to two radii wide. Balls without extent have the finest one.
int grid_exponent(const Ball& ball) {
  constexpr int kFinest = -1000;
  return ball.radius > 0 ? std::ilogb(ball.radius) + 1 : kFinest;
}

// Cells that are far from each other may share a key; then a question looks at more balls.
std::uint64_t key_of(const SpaceCell& cell) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  std::uint64_t key = 0;
  for (const std::int64_t c : cell) key = key << 21 | (static_cast<std::uint64_t>(c) & kMask);
  return key;
}

}  // namespace

void NearBalls::add(const Ball& ball, std::uint32_t number) {
  const int exponent = grid_exponent(ball);
  auto grid = std::ranges::find(grids_, exponent, &Grid::exponent);
  if (grid == grids_.end()) grid = grids_.insert(grids_.end(), {exponent, {}});
  const std::uint64_t key = key_of(cell_at(ball.center, std::ldexp(1, -exponent)));
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
    for_each_cell(ball.center, reach, std::ldexp(1, -grid.exponent), [&](const SpaceCell& cell) {
      for (std::uint32_t i = grid.first.find(key_of(cell)); i != kNone; i = entries_[i].next) look_at(entries_[i]);
    });
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace reeb::ooc
