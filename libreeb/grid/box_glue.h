// Glues the fragments of the boxes of a grid, in the order of GridBoxes. It is to boxes what Glue is to triangles
// (libreeb/engine/glue.h), without paths: two neighbours are joined by the trees that they are (box_union.h).
//
// Only boxes are joined: neighbours along the first axis, until they are a row; then rows, until they are a layer; and
// the layer with what came before. Of a row, the first half is joined before it meets the second half, and so on down,
// so that a box does not cost a pass over all the others.
//
// TIME: nearly linear in nodes, times the log of the boxes of a layer. MEMORY: proportional to the front.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/state_stream.h"
#include "libreeb/containers/flat_map.h"
#include "libreeb/grid/box_union.h"
#include "libreeb/port/graph_sink.h"
#include "libreeb/sweep/fragment.h"

namespace reeb {

class BoxGlue {
 public:
  explicit BoxGlue(GraphSink& sink) : sink_(&sink) {}

  // Adds the fragment of the next box. REQUIRES: its options are not less than those of earlier ones.
  // THROWS: DamagedState if a restored state was no state of this grid.
  void add(const Fragment& fragment);

  // The state so far, from which another process can continue. What was passed to the sink is not part of it.
  // REQUIRES: the last box was the last one of a layer.
  void save(StateWriter& out) const;
  // THROWS: DamagedState; then the object must not be used any more.
  void restore(StateReader& in);

  std::uint64_t removed_pairs() const { return removed_pairs_; }  // as noise, so far
  std::size_t live_vertices() const { return nodes_ahead_.size(); }
  static std::size_t live_edges() { return 0; }
  std::size_t live_arcs() const;
  std::uint64_t vertex_bound() const;  // more than the id of any node's vertex
  std::size_t memory_bytes() const;
  // The most that adding this fragment can make of it.
  std::size_t memory_bytes_with(const Fragment& fragment) const;

 private:
  // Of a run of boxes along an axis, which are whole rows if it is the second one, and whole layers if it is the third.
  struct Tree {
    Fragment fragment;
    std::size_t axis = 0;
    std::size_t boxes = 1;
  };

  template <class Join>
  void for_each_join(BoxFaces faces, Tree& tree, const Join& join) const;
  void note_nodes(const Fragment& fragment);
  void copy_buckets(const Fragment& fragment, Fragment& tree);

  GraphSink* sink_;
  std::uint64_t removed_pairs_ = 0;
  std::vector<Tree> trees_;  // none is next to the one before it in a run of the same length
  FlatMap nodes_ahead_;      // vertices that later boxes have, and that are nodes in an earlier one
  std::vector<std::uint32_t> first_passed_, next_passed_;  // of a fragment: by arc, and after each
  BoxUnion union_;
  Fragment result_;
};

}  // namespace reeb
