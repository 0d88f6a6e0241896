#include "libreeb/segmentation/parallel_arcs.h"

namespace reeb {

std::vector<ArcId> ParallelArcs::order() const {
  std::vector<ArcId> position(graph_.arc_count());
  std::vector<std::uint32_t> group;
  for (std::size_t begin = 0, end = 0; begin < position.size(); begin = end) {
    group.clear();
    for (; end < position.size() && same_ends(begin, end); ++end) group.push_back(static_cast<std::uint32_t>(end));
    if (any())
      std::stable_sort(group.begin(), group.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return first_vertex_[a] < first_vertex_[b]; });
    for (std::size_t i = 0; i < group.size(); ++i) position[group[i]] = ArcId(static_cast<std::uint32_t>(begin + i));
  }
  return position;
}

}  // namespace reeb
