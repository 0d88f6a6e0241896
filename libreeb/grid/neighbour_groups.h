// The neighbours of a vertex in the division of a grid, and how they are connected.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace reeb {

inline constexpr unsigned kNeighbours = 14;

// Neighbour n < 7 is up the subset n + 1 of the axes, neighbour 7 + n is down it.
constexpr std::array<int, 3> step_to(unsigned neighbour) {
  const unsigned axes = neighbour % 7 + 1;
  const int sign = neighbour < 7 ? 1 : -1;
  return {sign * static_cast<int>(axes & 1), sign * static_cast<int>(axes >> 1 & 1),
          sign * static_cast<int>(axes >> 2)};
}

using NeighbourSet = std::uint16_t;

// For each set of neighbours: one of each group, where the edges within the set connect a group. 2^14 entries.
const std::vector<NeighbourSet>& groups_of_sets();

}  // namespace reeb
