// The neighbours of a vertex in the division of a grid, and how they are connected.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace reeb {

inline constexpr unsigned kNeighbours = 14;

// A step along each axis of a set: up with sign 1, down with -1.
constexpr std::array<int, 3> step_along(unsigned axes, int sign) {
  return {sign * static_cast<int>(axes & 1), sign * static_cast<int>(axes >> 1 & 1),
          sign * static_cast<int>(axes >> 2)};
}

// Neighbour n < 7 is up the subset n + 1 of the axes, neighbour 7 + n is down it.
constexpr std::array<int, 3> step_to(unsigned neighbour) {
  return step_along(neighbour % 7 + 1, neighbour < 7 ? 1 : -1);
}

using NeighbourSet = std::uint16_t;

// For each set of neighbours: one of each group, where the edges within the set connect a group. 2^14 entries.
const std::vector<NeighbourSet>& groups_of_sets();

}  // namespace reeb
