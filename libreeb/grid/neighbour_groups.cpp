#include "libreeb/grid/neighbour_groups.h"

#include <bit>
#include <cstddef>

namespace reeb {
namespace {

// An edge of the division steps along a set of axes, all in the same direction.
constexpr bool is_edge(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  bool up = true, down = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const int step = b[k] - a[k];
    if (step < -1 || step > 1) return false;
    up &= step >= 0;
    down &= step <= 0;
  }
  return up || down;
}

constexpr std::array<NeighbourSet, kNeighbours> make_adjacency() {
  std::array<NeighbourSet, kNeighbours> adjacent{};
  for (unsigned a = 0; a < kNeighbours; ++a)
    for (unsigned b = 0; b < kNeighbours; ++b)
      if (a != b && is_edge(step_to(a), step_to(b))) adjacent[a] = static_cast<NeighbourSet>(adjacent[a] | 1u << b);
  return adjacent;
}

// For each set of neighbours: one of each group, where the edges within the set connect a group.
std::vector<NeighbourSet> make_groups() {
  constexpr auto kAdjacent = make_adjacency();
  std::vector<NeighbourSet> groups(std::size_t{1} << kNeighbours);
  for (unsigned set = 0; set < groups.size(); ++set) {
    unsigned chosen = 0;
    for (unsigned left = set; left != 0;) {
      const unsigned first = left & (~left + 1);
      chosen |= first;
      for (unsigned pending = first; pending != 0;) {
        const int next = std::countr_zero(pending);
        left &= ~(1u << next);
        pending = (pending & (pending - 1)) | (kAdjacent[static_cast<std::size_t>(next)] & left);
      }
    }
    groups[set] = static_cast<NeighbourSet>(chosen);
  }
  return groups;
}

}  // namespace

const std::vector<NeighbourSet>& groups_of_sets() {
  static const std::vector<NeighbourSet> groups = make_groups();
  return groups;
}

}  // namespace reeb
