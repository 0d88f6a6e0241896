// Records the nodes and arcs of a sweep, and reduces them to a fragment.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/sweep/chunk_embedding.h"
#include "libreeb/sweep/chunk_leaf_removal.h"
#include "libreeb/sweep/fragment.h"
#include "libreeb/sweep/fragment_division.h"
#include "libreeb/sweep/shared_edges.h"
#include "libreeb/sweep/sweep_graph.h"
#include "libreeb/sweep/sweep_options.h"

namespace reeb {

class FragmentBuilder {
 public:
  void start(std::size_t vertices, const SweepOptions& options);

  SweepNode add_node(VertexRank v);
  SweepArc add_arc(SweepNode lower_node);
  void end_arc(SweepArc arc, SweepNode upper_node) { graph_.arcs[arc].hi = upper_node; }
  // Notes that the node has this arc and no other.
  void note_leaf(SweepNode node, SweepArc arc) { graph_.leaves.push_back({node, arc}); }
  // Notes a regular vertex, which no other chunk uses, on the arc. REQUIRES: the options say that they are noted.
  void note_regular(SweepArc arc, LocalVertex v) { arc_of_regular_[v] = arc; }
  // Sets the arc up from `node` that a path takes unless another branch is noted for it.
  void set_main_branch(SweepNode node, SweepArc arc) { graph_.nodes[node].main_branch = arc; }

  // What was recorded so far.
  const SweepGraph& graph() const { return graph_; }
  // Notes that a node has settled arcs, too, which are not recorded.
  void set_lost_arcs(SweepNode node) { graph_.nodes[node].lost_arcs = true; }
  // After finish(): the open arc of the fragment that has this arc.
  FragmentArc open_arc(SweepArc arc) const { return graph_.arcs[graph_.present(arc)].open; }

  // To be called when the sweep is over. REQUIRES: every arc has both ends.
  void end_sweep(const SweptChunk& swept);
  // After that, if there is an embedding: vertices of the arc that are not vertices of the chunk.
  void add_bucket(SweepArc arc, const BucketSum& bucket) { graph_.buckets.add(graph_.arc_buckets[arc], bucket); }
  // Replaces `fragment`. REQUIRES: `shared` has all shared edges of the chunk.
  void finish(const SweptChunk& swept, const SharedEdges& shared, Fragment& fragment);
  // The same where the graph is a tree, and other chunks can change the arcs between vertices that they use, and no
  // others.
  void finish_tree(const SweptChunk& swept, Fragment& fragment);
  std::size_t memory_bytes() const;

 private:
  // A step of gluing, packed into a number that sorts in the order of steps. It zips the shared edge, or completes the
  // node, with this index.
  class PackedStep {
   public:
    PackedStep(std::uint32_t place, std::uint32_t index, bool completes)
        : bits_(std::uint64_t{place} << 32 | (completes ? kCompletes : 0) | index) {}
    bool completes() const { return (bits_ & kCompletes) != 0; }
    std::uint32_t index() const { return static_cast<std::uint32_t>(bits_ & (kCompletes - 1)); }
    std::uint32_t place() const { return static_cast<std::uint32_t>(bits_ >> 32); }
    friend auto operator<=>(const PackedStep&, const PackedStep&) = default;

   private:
    static constexpr std::uint64_t kCompletes = std::uint64_t{1} << 31;
    std::uint64_t bits_;
  };

  void start_fragment(const SweptChunk& swept, Fragment& fragment);
  void mark_arcs_between_used();
  void add_followed(const SweptChunk& swept, Fragment& fragment);
  void sort_steps(const SweptChunk& swept, const SharedEdges& shared);
  void trace_paths(const SharedEdges& shared, Fragment& fragment);
  void add_steps(const SharedEdges& shared, Fragment& fragment) const;

  SweepOptions options_;
  SweepGraph graph_;
  ChunkEmbedding embedding_;
  ChunkLeafRemoval leaf_removal_;
  FragmentDivision division_;
  IdVector<VertexRank, SweepNode> node_of_;         // set for nodes only
  IdVector<LocalVertex, SweepArc> arc_of_regular_;  // of other vertices, none()
  std::vector<PackedStep> steps_;                   // sorted
  std::vector<SweepArc> path_arcs_;                 // as in the fragment
  std::vector<std::uint32_t> degrees_, arcs_xor_;   // of a tree, by node
  std::vector<SweepNode> leaves_;
  std::vector<std::uint32_t> settled_number_;  // by arc of the sweep
};

}  // namespace reeb
