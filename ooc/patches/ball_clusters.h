// Balls that meet, directly or through others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ooc/patches/ball_grid.h"

namespace reeb::ooc {

// Each ball is in one group; groups, and the balls of each, ascend.
// TIME: proportional to the pairs of balls that are near each other.
std::vector<std::vector<std::uint32_t>> clusters_of(std::span<const Ball> balls);

}  // namespace reeb::ooc
