// Noise removal in one chunk: leaves that are noise whatever the other chunks are (docs/SEMANTICS.md, Noise removal).
//
// A leaf whose vertex is used in this chunk only is a leaf of the whole graph, with the same saddle, since no path of a
// shared edge uses its arc. And a path in the graph of the chunk is a path in the whole graph. So a step that is right
// here is right in the whole graph.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/sweep/sweep_graph.h"

namespace reeb {

class ChunkLeafRemoval {
 public:
  // Removes, until nothing changes, leaves of persistence < noise_below whose saddle has another path in their
  // direction that reaches beyond them. Saddles that are used here only are contracted when they become (1, 1) nodes.
  // The vertices of a leaf's arc, and the leaf, are moved to that other path. Returns the number of removed leaves.
  // If such leaves are few, only the arcs at their saddles are examined; the last pass over the whole graph removes
  // the leaves for which that does not suffice.
  // O(leaves) if no leaf has a persistence < noise_below, else O(nodes + arcs), most of it for finding other paths.
  std::size_t run(SweepGraph& graph, const SweptChunk& swept, double noise_below);
  std::size_t memory_bytes() const;

 private:
  // The arcs of a node on each side: their number, and the xor of their ids, which is the arc if there is only one.
  struct Node {
    std::array<std::uint32_t, 2> degree;
    std::array<std::uint32_t, 2> arcs_xor;
    std::array<SweepNode, 2> reach;  // the farthest node on monotone paths
    std::array<SweepArc, 2> via;     // the first arc on the path to it
  };

  void find_candidates();
  void choose_whole_nodes();
  void prepare();
  void extend_reach(SweepNode node, Direction d, SweepArc arc);
  void try_leaf(SweepNode leaf, Direction d);
  void settle(SweepNode saddle);
  void contract(SweepNode node);
  void move_buckets(SweepNode leaf, SweepArc arc, Direction d);
  void attach(SweepNode node, Direction d, SweepArc arc);
  void detach(SweepNode node, Direction d, SweepArc arc);
  bool is_used_here_only(SweepNode node) const { return graph_->nodes[node].uses == kUsedHereOnly; }
  bool is_noise(SweepArc arc) const { return graph_->length(graph_->arcs[arc]) < noise_below_; }
  bool embeds() const { return !graph_->arc_buckets.empty(); }
  double value(SweepNode node) const { return graph_->nodes[node].key.value; }
  Point position(SweepNode node) const { return swept_->position(graph_->nodes[node].vertex); }
  SweepArc only_arc(SweepNode node, Direction d) const { return SweepArc(nodes_[node].arcs_xor[d]); }
  bool is_leaf(SweepNode node, Direction d) const {
    return nodes_[node].degree[d] == 0 && nodes_[node].degree[opposite(d)] == 1;
  }

  SweepGraph* graph_ = nullptr;
  const SweptChunk* swept_ = nullptr;
  double noise_below_ = 0;
  std::size_t removed_ = 0;
  IdVector<SweepNode, Node> nodes_;
  IdVector<SweepNode, std::uint8_t> whole_;  // whether all arcs of a node are in nodes_; other nodes stay as they are
  std::vector<SweepArc> arcs_;               // first those of candidates; then all arcs of whole nodes, ascending
  std::vector<PathBuckets> path_;
  std::vector<SweepNode> candidates_;  // nodes to examine, which might be leaves
};

}  // namespace reeb
