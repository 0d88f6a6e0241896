// Noise removal in one chunk: leaves that no other chunk can save (DESIGN.md 1.6, 5).
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

class LeafRemoval {
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
    std::array<std::uint32_t, 2> reach;  // the farthest node on monotone paths
    std::array<std::uint32_t, 2> via;    // the first arc on the way there
  };

  void find_candidates();
  void choose_whole_nodes();
  void prepare();
  void extend_reach(std::uint32_t node, Direction d, std::uint32_t arc);
  void try_leaf(std::uint32_t leaf, Direction d);
  void settle(std::uint32_t saddle);
  void contract(std::uint32_t node);
  void move_buckets(std::uint32_t leaf, std::uint32_t arc, Direction d);
  void attach(std::uint32_t node, Direction d, std::uint32_t arc);
  void detach(std::uint32_t node, Direction d, std::uint32_t arc);
  bool is_used_here_only(std::uint32_t node) const;
  bool is_noise(std::uint32_t arc) const { return graph_->length(graph_->arcs[arc]) < noise_below_; }
  bool embeds() const { return !graph_->arc_buckets.empty(); }
  double value(std::uint32_t node) const { return graph_->nodes[node].key.value; }
  Point position(std::uint32_t node) const { return swept_->position(graph_->nodes[node].vertex); }
  bool is_leaf(std::uint32_t node, Direction d) const {
    return nodes_[node].degree[d] == 0 && nodes_[node].degree[opposite(d)] == 1;
  }

  SweepGraph* graph_ = nullptr;
  const SweptChunk* swept_ = nullptr;
  double noise_below_ = 0;
  std::size_t removed_ = 0;
  std::vector<Node> nodes_;
  std::vector<std::uint8_t> whole_;  // by node: whether it knows all its arcs; nothing is done at others
  std::vector<std::uint32_t> arcs_;  // of candidates; then all that whole nodes have, ascending
  std::vector<PathBuckets> path_;
  std::vector<std::uint32_t> candidates_;  // nodes that may be leaves to be looked at
};

}  // namespace reeb
