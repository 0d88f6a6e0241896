// Joins the fragments of two boxes with a common face (docs/ARCHITECTURE.md, Grids).
//
// Both boxes, their face and their union are contractible, so the graphs of the boxes and of the union are trees. A
// component of a sublevel set of the face has a least vertex. It is an extremum of the face, so it is a node in both
// trees. So the two trees with equal nodes made one have the same components of sublevel sets as the union, joined in
// the same places: they have its join tree. In the same way they have its split tree. The two determine the tree of the
// union, and no path is followed.
//
// What no node on a shared face separates from the others hangs on the rest by a single node, and cannot change: the
// face is connected, so its contours are those between its extrema.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/grid/contour_tree.h"
#include "libreeb/grid/tree_sweep.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/fragment.h"

namespace reeb {

// TIME: nearly linear in nodes, plus O(log nodes) for each bucket of an arc that is cut. MEMORY: scratch of about
// kBytesPerNode for each node of both, kept for the next union.
class BoxUnion {
 public:
  static constexpr std::size_t kBytesPerNode = 400;

  // Replaces `result` by the fragment of both. `before` has the common face at its high end of `axis`, `after` at its
  // low end. REQUIRES: `result` is another fragment; the options are not less than those of the fragments.
  // THROWS: DamagedState if these are not fragments of such boxes.
  void run(const Fragment& before, const Fragment& after, std::size_t axis, const SweepOptions& options,
           Fragment& result);
  std::size_t memory_bytes() const;

 private:
  // The place of a vertex in the rooted tree. `jump` is an ancestor, chosen such that any ancestor can be reached in
  // O(log) steps to a parent or a jump.
  struct Place {
    std::uint32_t depth, jump;
  };
  // The path between the ends of a former arc. It rises from `lo` to `hi`; `top` is nearest to the root.
  struct Path {
    std::uint32_t lo, hi, top;
  };

  void merge_nodes(const Fragment& before, const Fragment& after, std::size_t axis);
  void add_node(const Fragment& fragment, std::size_t i, BoxFaces no_longer_shared);
  void add_arcs(const Fragment& fragment, const std::vector<std::uint32_t>& ranks);
  void place_vertices();
  void move_buckets(const Fragment& fragment, const std::vector<std::uint32_t>& ranks, int exponent);
  void move_bucket(const Path& path, BucketSum bucket, int exponent);
  Path path_between(std::uint32_t lo, std::uint32_t hi) const;
  SweepArc arc_at(const Path& path, double value) const;
  template <class May>
  std::uint32_t climb(std::uint32_t v, const May& may) const;

  Chunk chunk_;  // the nodes of both, as vertices
  std::vector<double> values_;
  std::vector<std::uint32_t> order_;  // 0, 1, 2, ...
  std::vector<TreeSweep::Keep> keep_;
  std::array<std::vector<std::uint32_t>, 2> ranks_;  // by node of either fragment
  std::vector<ContourTree::Arc> arcs_;
  ContourTree tree_;
  TreeSweep sweep_;
  std::vector<Place> places_;
};

}  // namespace reeb
