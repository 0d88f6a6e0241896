// From a contour tree to a fragment: what boxes of a grid and unions of boxes have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/grid/contour_tree.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/fragment.h"
#include "libreeb/sweep/fragment_builder.h"

namespace reeb {

class TreeSweep {
 public:
  // How a vertex is kept. A regular vertex is no node.
  enum Keep : std::uint8_t { kIfNotRegular, kAlways, kWithLostArcs };

  // Records the tree of a chunk; keep[r] is that of the vertex of rank r.
  // REQUIRES: a vertex with lost arcs is on no shared face.
  void run(const SweptChunk& swept, const ContourTree& tree, std::span<const Keep> keep, const SweepOptions& options);
  // After that: the arc that has an edge of the tree.
  SweepArc arc_of(std::uint32_t edge) const { return arc_of_[edge]; }
  const SweepGraph& graph() const { return builder_.graph(); }
  // As that of the builder.
  void add_bucket(SweepArc arc, const BucketSum& bucket) { builder_.add_bucket(arc, bucket); }
  // At the end: replaces `fragment`.
  void finish(const SweptChunk& swept, Fragment& fragment);
  std::size_t memory_bytes() const;

 private:
  void visit(const SweptChunk& swept, const ContourTree& tree, std::uint32_t v, Keep keep);

  FragmentBuilder builder_;
  bool embeds_ = false;
  std::vector<SweepArc> arc_of_;  // by edge of the tree
  std::vector<std::pair<LocalVertex, SweepArc>> passed_;
};

}  // namespace reeb
