// The Reeb graph of one chunk by one sweep over its vertices
// (docs/ARCHITECTURE.md, The sweep of one chunk).
//
// Just above a vertex the level set is a graph: its points are the mesh edges that cross the
// level, its segments the triangles that do. Each crossing triangle carries a label; a union-find
// maps labels to arcs. A vertex whose upward edges hang together through its own triangles needs
// no search: exactly one arc leaves it. Only where they fall into several groups is the level set
// walked, from all groups in lockstep, and only the smaller sides are relabelled.
//
// TIME: O(sort) plus the stars of all vertices plus the smaller sides walked; a vertex of any
// degree and an edge with any number of triangles cost their size once.
// MEMORY: scratch of about 70 bytes a triangle of a surface (a random function: 92), kept for the
// next chunk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "libreeb/engine/chunk.h"
#include "libreeb/engine/fragment.h"

namespace reeb {

class ChunkSweep {
 public:
  ChunkSweep();
  ~ChunkSweep();
  ChunkSweep(ChunkSweep&&) noexcept;
  ChunkSweep& operator=(ChunkSweep&&) noexcept;

  // Replaces `fragment` by that of `chunk` with values[i] at local vertex i.
  void run(const Chunk& chunk, std::span<const double> values, Fragment& fragment, const SweepOptions& options = {});
  std::size_t memory_bytes() const;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace reeb
