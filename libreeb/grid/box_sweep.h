// The fragment of a box of grid vertices (docs/ARCHITECTURE.md, Grids).
//
// Two boxes have a face of the grid in common. The vertices that are extrema of the function on the face alone are
// nodes in both, and all that is needed to join the two (box_union.h).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/grid/contour_tree.h"
#include "libreeb/grid/tree_sweep.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/fragment.h"
#include "libreeb/sweep/vertex_ranks.h"

namespace reeb {

// TIME: O(sort) plus about 100 ns per vertex. MEMORY: memory_bytes(), kept for the next box.
class BoxSweep {
 public:
  // Replaces `fragment` by that of `chunk`, where local vertex i has the value values[i].
  // REQUIRES: chunk.box[0] != 0.
  void run(const Chunk& chunk, std::span<const double> values, Fragment& fragment, const SweepOptions& options = {});
  std::size_t memory_bytes() const;
  // About this much is needed for a box.
  static std::size_t least_memory_bytes(const Chunk& chunk) { return 100 * chunk.vertex_count(); }

 private:
  VertexRanks ranks_;
  ContourTree tree_;
  TreeSweep sweep_;
  std::vector<TreeSweep::Keep> keep_;  // by rank
};

}  // namespace reeb
