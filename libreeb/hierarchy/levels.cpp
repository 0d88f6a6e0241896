#include "libreeb/hierarchy/levels.h"

#include <algorithm>

#include "libreeb/hierarchy/subgraph.h"

namespace reeb {

std::uint32_t version_below(const Hierarchy& hierarchy, double threshold) {
  const auto& steps = hierarchy.persistence;
  return static_cast<std::uint32_t>(std::lower_bound(steps.begin(), steps.end(), threshold) - steps.begin());
}

std::vector<LevelSize> level_sizes(const Hierarchy& hierarchy) {
  const std::uint32_t last = last_version(hierarchy);
  // Arcs born in each version minus those that died; negative differences wrap.
  std::vector<std::uint64_t> arc_change(last + 1);
  for (const ArcVersion& arc : hierarchy.arcs) {
    ++arc_change[arc.born];
    if (arc.died != kNeverDies) --arc_change[arc.died];
  }
  std::uint64_t components = 0, loops = 0;
  for (const PersistencePair& pair : hierarchy.pairs) {
    if (pair.type == PairType::kExt0) ++components;
    if (pair.type == PairType::kExt1) ++loops;
  }

  std::vector<LevelSize> sizes;
  sizes.reserve(last + 1);
  std::uint64_t arcs = arc_change[0];
  // Every cancelled loop lowers b1 by one, and nothing else changes a Betti number.
  const auto add = [&](double persistence) { sizes.push_back({persistence, arcs + components - loops, arcs}); };
  add(0);
  for (const PersistencePair& pair : hierarchy.pairs) {
    if (pair.type == PairType::kExt0 || pair.kept) continue;
    if (pair.type == PairType::kExt1) --loops;
    arcs += arc_change[sizes.size()];
    add(hierarchy.persistence[sizes.size() - 1]);
  }
  return sizes;
}

std::uint32_t finest_with_nodes(const std::vector<LevelSize>& sizes, std::uint64_t nodes) {
  const auto it =
      std::partition_point(sizes.begin(), sizes.end(), [nodes](const LevelSize& size) { return size.nodes > nodes; });
  return static_cast<std::uint32_t>(it - sizes.begin());
}

ReebGraph graph_at(const Hierarchy& hierarchy, const ReebGraph& full, std::uint32_t version) {
  std::vector<NodeArc> arcs;
  for (const ArcVersion& arc : hierarchy.arcs) {
    if (arc.died <= version) break;
    if (arc.born <= version) arcs.push_back({arc.lo, arc.hi});
  }
  return subgraph(full, std::move(arcs), hierarchy.isolated);
}

}  // namespace reeb
