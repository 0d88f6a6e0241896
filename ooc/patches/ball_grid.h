// Balls in space, and which of them contain a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/settled_node.h"
#include "ooc/patches/space_cells.h"

namespace reeb::ooc {

struct Ball {
  Point center{};
  double radius = 0;
  bool contains(const Point& point) const {
    const double x = point[0] - center[0], y = point[1] - center[1], z = point[2] - center[2];
    return x * x + y * y + z * z <= radius * radius;
  }
};

// A grid for each power of two of the radius, all in one hash table of balls. A question looks into one cell of each.
// MEMORY: about 100 bytes per ball.
class BallGrid {
 public:
  explicit BallGrid(std::span<const Ball> balls);
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // The number of a ball that contains the point; kNone if there is none.
  std::uint32_t find(const Point& point) const {
    std::uint32_t found = kNone;
    visit(point, [&](std::uint32_t ball) {
      found = ball;
      return false;
    });
    return found;
  }
  // Calls look(ball) for the balls that contain the point, in no order; for some of them perhaps repeatedly. Ends when
  // look() returns false.
  template <class Look>
  void visit(const Point& point, const Look& look) const {
    for (const Grid& grid : grids_) {
      const std::size_t slot = slot_of(grid, cell_at(point, grid.cells_per_unit));
      for (std::uint32_t i = first_[slot]; i < first_[slot + 1]; ++i)
        if (balls_[entries_[i]].contains(point) && !look(entries_[i])) return;
    }
  }
  std::uint64_t memory_bytes() const {
    return balls_.capacity() * sizeof(Ball) + (first_.capacity() + entries_.capacity()) * 4;
  }

 private:
  struct Grid {
    int exponent;
    double cells_per_unit;
  };

  std::size_t slot_of(const Grid& grid, const SpaceCell& cell) const {
    auto key = static_cast<std::uint64_t>(grid.exponent);
    for (const std::int64_t c : cell) key = (key ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>((key ^ key >> 32) & mask_);
  }
  template <class Visit>
  void for_each_slot(const Ball& ball, const Visit& visit) const;

  std::vector<Ball> balls_;
  std::vector<Grid> grids_;
  std::size_t mask_ = 0;
  std::vector<std::uint32_t> first_, entries_;  // of each slot; cells that share one are told apart by their balls
};

}  // namespace reeb::ooc
