// A growing set of balls, and which of them meet another one.
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/containers/flat_map.h"
#include "ooc/patches/ball_grid.h"

namespace reeb::ooc {

// A grid for each power of two of the radius; each ball is in the cell of its center. MEMORY: about 100 bytes a ball.
class NearBalls {
 public:
  void add(const Ball& ball, std::uint32_t number);

  // The numbers of those that meet the ball, ascending. TIME: proportional to those near it.
  std::vector<std::uint32_t> meeting(const Ball& ball) const;

 private:
  struct Entry {
    Ball ball;
    std::uint32_t number, next;
  };
  struct Grid {
    int exponent;
    FlatMap first;  // the entry of each cell
  };
  static constexpr std::uint32_t kNone = FlatMap::kNone;

  std::vector<Grid> grids_;
  std::vector<Entry> entries_;
};

}  // namespace reeb::ooc
