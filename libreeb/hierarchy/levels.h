// Levels of a hierarchy in memory: which version belongs to a threshold, how large it is, and its graph
// (docs/SEMANTICS.md, Levels).
//
// For users of the library who build a hierarchy in memory, for instance with build_hierarchy() after OnlineReeb. The
// program itself reads levels from files (ooc/reeb_file).
//
// A version is a number of cancellations; kept loops and Ext0 pairs do not count. Node ids are those of the full graph
// from which the hierarchy was built.
//
// THREADS: nothing here changes its arguments; any number of calls at the same time.
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb {

// The coarsest version.
inline std::uint32_t last_version(const Hierarchy& hierarchy) {
  return static_cast<std::uint32_t>(hierarchy.persistence.size());
}

// The version in which every pair of persistence < threshold is cancelled, and no other. O(log n).
std::uint32_t version_below(const Hierarchy& hierarchy, double threshold);

struct LevelSize {
  double persistence = 0;  // of the last pair that is cancelled, which is below the threshold; 0 in version 0
  std::uint64_t nodes = 0;
  std::uint64_t arcs = 0;
};

// One entry per version, starting with version 0. Neither nodes nor arcs ever become more. O(records + pairs).
std::vector<LevelSize> level_sizes(const Hierarchy& hierarchy);

// The finest version with at most `nodes` nodes; the number of versions if even the coarsest is larger. `sizes` is
// level_sizes of the hierarchy. O(log n).
std::uint32_t finest_with_nodes(const std::vector<LevelSize>& sizes, std::uint64_t nodes);

// The graph of a version. It reads only the records that died after the version: O(r + k log k) for r such records and
// k arcs in the result.
ReebGraph graph_at(const Hierarchy& hierarchy, const ReebGraph& full, std::uint32_t version);

}  // namespace reeb
