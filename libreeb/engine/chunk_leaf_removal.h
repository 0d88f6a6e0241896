// Noise removal in one chunk: leaves that no other chunk can save
// (docs/SEMANTICS.md, Noise removal).
//
// A leaf whose vertex is used in this chunk only is a leaf of the whole graph, with the same
// saddle, since no path of a shared edge runs on its arc; and a path of the chunk's graph is one
// of the whole graph. So a step that is right here is right there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/engine/sweep_graph.h"

namespace reeb {

class ChunkLeafRemoval {
 public:
  // Removes, until nothing changes, extrema with one arc of persistence < noise_below whose saddle
  // has another path in their direction that reaches beyond them; saddles used here only
  // disappear when they become (1, 1). What lay on a leaf's arc comes to lie on that other path,
  // the leaf with it. Returns how many leaves are gone. If such leaves are few, only the arcs at their
  // saddles are looked at: what takes longer ways to be seen is left, for whoever sees all of the graph.
  // O(leaves) if none is of so little persistence, else O(nodes + arcs), most of it for the looks.
  std::size_t run(SweepGraph& graph, const SweptChunk& swept, double noise_below);
  std::size_t memory_bytes() const;

 private:
  // A node's arcs on each side, by their number and the exclusive or of their ids: enough to find
  // the arc of a side that has only one.
  struct Node {
    std::array<std::uint32_t, 2> degree;
    std::array<std::uint32_t, 2> arcs_xor;
    std::array<SweepNode, 2> reach;  // the farthest node on monotone paths
    std::array<SweepArc, 2> via;     // the first arc on the way there
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
  bool is_used_here_only(SweepNode node) const;
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
  IdVector<SweepNode, std::uint8_t> whole_;  // by node: whether it knows all its arcs; nothing is done at others
  std::vector<SweepArc> arcs_;               // of candidates; then all that whole nodes have, ascending
  std::vector<PathBuckets> path_;
  std::vector<SweepNode> candidates_;  // nodes that may be leaves to be looked at
};

}  // namespace reeb
