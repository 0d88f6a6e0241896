// The Reeb graph of one chunk by one sweep over its vertices
// (docs/ARCHITECTURE.md, The sweep of one chunk).
//
// Just above a vertex the level set is a graph: its points are the mesh edges that cross the level, its segments the
// triangles that do. Each crossing triangle carries a label; a union-find maps labels to arcs. If the edges up from a
// vertex are connected by the triangles of the vertex, exactly one arc leaves it, and no search is needed. If they are
// in several groups, the sweep walks the level set from all groups in lockstep, and relabels only the smaller sides.
//
// TIME: O(sort) plus the stars of all vertices plus the smaller sides walked. A vertex costs its degree once, an edge
//       the number of its triangles once.
// MEMORY: scratch of about 70 bytes per triangle of a surface (92 for a random function), kept for the next chunk.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/fragment.h"

namespace reeb {

class ChunkSweep {
 public:
  ChunkSweep();
  ~ChunkSweep();
  ChunkSweep(ChunkSweep&&) noexcept;
  ChunkSweep& operator=(ChunkSweep&&) noexcept;

  // Replaces `fragment` by that of `chunk`, where local vertex i has the value values[i].
  void run(const Chunk& chunk, std::span<const double> values, Fragment& fragment, const SweepOptions& options = {});
  std::size_t memory_bytes() const;
  // At least this much is needed for a chunk.
  static std::size_t least_memory_bytes(const Chunk& chunk) {
    return 20 * chunk.triangle_count() + 100 * chunk.vertex_count();
  }

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace reeb
