// Levels of a hierarchy in memory: which version belongs to a threshold, how large it is, and its graph
// (docs/SEMANTICS.md, Levels).
//
// For users of the library who build a hierarchy in memory, as with build_hierarchy() after OnlineReeb.
// The program itself reads levels from files (ooc/reeb_file). A Hierarchy that does not change may be
// asked by several threads at once.
//
// A version is a number of cancellations; kept loops and Ext0 pairs are none. Node ids are those of
// the full graph that the hierarchy was built from.
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
  double threshold = 0;  // persistence of the last pair cancelled; 0 in version 0
  std::uint64_t nodes = 0;
  std::uint64_t arcs = 0;
};

// One entry a version, from version 0 on; neither nodes nor arcs ever grow. O(records + pairs).
std::vector<LevelSize> level_sizes(const Hierarchy& hierarchy);

// The finest version with at most `nodes` nodes; the number of versions if even the coarsest is
// larger. `sizes` is level_sizes of the hierarchy. O(log n).
std::uint32_t finest_with_nodes(const std::vector<LevelSize>& sizes, std::uint64_t nodes);

// The graph of a version. Looks only at the records that died after it: O(r + k log k) for r of
// those and k arcs in the result.
ReebGraph graph_at(const Hierarchy& hierarchy, const ReebGraph& full, std::uint32_t version);

}  // namespace reeb
