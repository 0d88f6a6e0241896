// Takes down the arcs of a sweep and reduces them to a fragment.
//
// The path of a shared edge is not traced along the way: above a node with one arc up it is
// implied, and at a split only the edges on relabelled sides are noted; all others follow the
// main branch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/engine/fragment.h"
#include "libreeb/engine/leaf_removal.h"
#include "libreeb/engine/sweep_graph.h"
#include "libreeb/engine/sweep_options.h"

namespace reeb {

// Vertices are ranks; nodes and arcs are numbered in order of creation.
class FragmentBuilder {
 public:
  void start(std::size_t vertices, const SweepOptions& options);
  // The sweep arrives at v; to be called for 0, 1, 2, ...
  void reach(std::uint32_t v) { shared_begin_[v] = static_cast<std::uint32_t>(shared_.size()); }

  std::uint32_t add_node(std::uint32_t v);
  std::uint32_t add_arc(std::uint32_t lower_node);
  void end_arc(std::uint32_t arc, std::uint32_t upper_node) { graph_.arcs[arc].hi = upper_node; }
  // The node has this arc and no other.
  void note_leaf(std::uint32_t node, std::uint32_t arc) { graph_.leaves.push_back({node, arc}); }
  // From here on vertices are in the bucket of this index, which rises from call to call.
  void start_bucket(std::int64_t index) { graph_.buckets.start_bucket(index); }
  // This vertex of the chunk, which no other chunk uses, is no node; it lies on the arc.
  void add_regular(std::uint32_t arc, std::uint32_t local_vertex) {
    bucket_of_[local_vertex] = graph_.buckets.bucket_at_hand(graph_.arc_buckets[arc]);
  }
  // The arc up from `node` that every path takes for which no other branch is noted.
  void set_main_branch(std::uint32_t node, std::uint32_t arc) { graph_.nodes[node].main_branch = arc; }

  // An edge from the vertex at hand up to `hi`, whose path starts with `arc`.
  void add_shared_edge(std::uint32_t lower_node, std::uint32_t hi, std::uint32_t arc, std::uint32_t place);
  // No more of them for v.
  void finish_shared_edges_of(std::uint32_t v);
  // If lo-hi is a shared edge, its path goes up from `node` by `arc`.
  void note_branch(std::uint32_t lo, std::uint32_t hi, std::uint32_t node, std::uint32_t arc);

  void finish(const SweptChunk& swept, Fragment& fragment);
  std::size_t memory_bytes() const;

 private:
  struct Shared {
    std::uint32_t lo, hi;  // node below, vertex above
    std::uint32_t first_arc, place;
    std::uint32_t first_note, last_note;
  };
  struct Note {
    std::uint32_t node, arc, next;
  };

  // A step as one number in the order of steps: zipping the shared edge, or completing the node,
  // with this index.
  static std::uint64_t step(std::uint32_t place, std::uint32_t index, bool completes) {
    return std::uint64_t{place} << 32 | (completes ? kCompletes : 0) | index;
  }
  static bool completes(std::uint64_t step) { return (step & kCompletes) != 0; }
  static std::uint32_t index(std::uint64_t step) { return static_cast<std::uint32_t>(step & (kCompletes - 1)); }
  static std::uint32_t place(std::uint64_t step) { return static_cast<std::uint32_t>(step >> 32); }
  static constexpr std::uint64_t kCompletes = std::uint64_t{1} << 31;

  void add_positions(const Chunk& chunk);
  void sort_steps(const SweptChunk& swept);
  void trace_paths(Fragment& fragment);
  void find_changing_nodes(const SweptChunk& swept);
  void divide(const SweptChunk& swept, Fragment& fragment);
  void add_nodes(const SweptChunk& swept, Fragment& fragment);
  void add_settled_arc(std::uint32_t arc, Fragment& fragment);
  void add_arcs(Fragment& fragment);
  void add_buckets(Fragment& fragment);
  void add_steps(Fragment& fragment);

  SweepOptions options_;
  SweepGraph graph_;
  LeafRemoval leaf_removal_;
  std::vector<Shared> shared_;
  std::vector<std::uint32_t> shared_begin_;  // by vertex; within a vertex sorted by hi
  std::vector<Note> notes_;
  std::vector<std::uint32_t> node_of_;         // by vertex, for those that are nodes
  std::vector<BucketLists::Index> bucket_of_;  // by local vertex; nowhere for nodes

  std::vector<std::uint64_t> steps_;    // sorted
  std::vector<std::uint32_t> node_at_;  // by local vertex: its node, if it is an open one
  std::vector<std::uint32_t> open_arcs_;
  std::vector<std::uint32_t> arc_at_;     // by number in the fragment
  std::vector<std::uint32_t> arcs_from_;  // by open node: where its arcs up are numbered from
};

}  // namespace reeb
