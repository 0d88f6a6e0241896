// Balls in space, and whether a point is in one of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/flat_map.h"
#include "libreeb/graph/settled_node.h"

namespace reeb::ooc {

struct Ball {
  Point center{};
  double radius = 0;
  bool contains(const Point& point) const {
    const double x = point[0] - center[0], y = point[1] - center[1], z = point[2] - center[2];
    return x * x + y * y + z * z <= radius * radius;
  }
};

// A grid for each power of two of the radius. A question looks into one cell of each.
// MEMORY: about 200 bytes per ball.
class BallGrid {
 public:
  explicit BallGrid(std::span<const Ball> balls);
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // The number of a ball that contains the point; kNone if there is none.
  std::uint32_t find(const Point& point) const;
  bool contains(const Point& point) const { return find(point) != kNone; }

 private:
  struct Entry {
    std::uint32_t ball, next;
  };
  struct Grid {
    int exponent;
    FlatMap first;  // the entry of each cell
  };

  std::vector<Ball> balls_;
  std::vector<Grid> grids_;
  std::vector<Entry> entries_;
};

}  // namespace reeb::ooc
