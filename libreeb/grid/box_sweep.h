// The fragment of a box of grid vertices (docs/ARCHITECTURE.md, Grids).
//
// Two boxes have a face of the grid in common. So that both know the same of it, each takes the Reeb graph of the
// function on the face alone. It is a tree, too, and each of its arcs maps to a monotone path in the graph of the box.
// These arcs take the place of the face's edges: to zip them identifies every point of the face. They are few where
// the function is smooth, and only their ends are kept as nodes.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/engine/chunk.h"
#include "libreeb/engine/fragment.h"
#include "libreeb/engine/fragment_builder.h"
#include "libreeb/engine/shared_edges.h"
#include "libreeb/engine/vertex_ranks.h"
#include "libreeb/grid/contour_tree.h"

namespace reeb {

// TIME: O(sort) plus about 150 ns per vertex. MEMORY: scratch of about 100 bytes per vertex, kept for the next box.
class BoxSweep {
 public:
  // Replaces `fragment` by that of `chunk`, where local vertex i has the value values[i].
  // REQUIRES: chunk.is_box(). The vertices of shared faces, and no others, are used by other chunks.
  void run(const Chunk& chunk, std::span<const double> values, Fragment& fragment, const SweepOptions& options = {});
  std::size_t memory_bytes() const;

 private:
  // An arc of the Reeb graph of a face, by vertices of the box.
  struct FaceArc {
    std::uint32_t lo, hi;
    friend auto operator<=>(const FaceArc&, const FaceArc&) = default;
  };
  // A node of the tree in search of a path: the arc to its parent, and how far it is from the root.
  struct Place {
    SweepArc to_parent;
    SweepNode parent;
    std::uint32_t depth;
  };

  void find_face_arcs(const Chunk& chunk, std::span<const double> values);
  void take_face(const Chunk& chunk, std::span<const double> values, std::size_t axis, bool high);
  void visit(const SweptChunk& swept, std::uint32_t v, bool embeds);
  void place_nodes();
  void add_paths();
  void add_passed(const Chunk& chunk, std::span<const double> values, Fragment& fragment) const;

  VertexRanks ranks_, face_ranks_;
  ContourTree tree_, face_tree_;
  FragmentBuilder builder_;
  SharedEdges shared_;
  std::vector<FaceArc> face_arcs_;
  std::vector<std::uint8_t> ends_face_arc_;  // by vertex
  std::vector<SweepArc> arc_of_;             // by edge of the tree
  std::vector<SweepNode> node_of_;           // by vertex; set for nodes
  std::vector<std::pair<LocalVertex, SweepArc>> passed_;

  // Of a face.
  std::vector<std::uint32_t> face_vertices_;  // in the box
  std::vector<double> face_values_;
  std::vector<VertexId> face_ids_;
  std::vector<std::uint32_t> lower_end_;  // by edge of the tree of the face

  // Of the search for paths.
  std::vector<Place> places_;
  std::vector<std::uint32_t> first_down_, next_down_;  // arcs down from a node, by node and by arc
  std::vector<std::uint32_t> arcs_from_;               // by node: its first arc up
  std::vector<SweepNode> queue_;
  std::vector<SweepArc> path_, from_above_;
};

}  // namespace reeb
