// The contour tree of a box of grid vertices: its Reeb graph before regular vertices are left out.
//
// A box without holes is contractible, so its Reeb graph is a tree. That tree follows from two others (Carr, Snoeyink,
// Axen 2003): the join tree says how components of sublevel sets merge, the split tree how those of superlevel sets do.
// Each takes one union-find pass over the vertices. A table tells how the neighbours below (or above) a vertex are
// connected, so a vertex costs one search for each group of them, not one for each neighbour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/engine/chunk.h"

namespace reeb {

// Vertices are named by their ranks, and an edge of the tree by one of its ends.
//
// TIME: nearly linear. MEMORY: about 50 bytes per vertex, kept for the next box.
class ContourTree {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // `order[r]` is the vertex of rank r. REQUIRES: a box of at least one vertex.
  void build(const BoxSize& size, std::span<const std::uint32_t> order);

  std::uint32_t degree_up(std::uint32_t v) const { return nodes_[v].degree[1]; }
  std::uint32_t degree_down(std::uint32_t v) const { return nodes_[v].degree[0]; }
  bool is_regular(std::uint32_t v) const { return degree_up(v) == 1 && degree_down(v) == 1; }
  // Calls visit(edge) for the edges from v to lower vertices.
  template <class Visit>
  void for_each_down(std::uint32_t v, const Visit& visit) const {
    for (std::uint32_t e = nodes_[v].first[0]; e != kNone; e = edges_[e].next[0]) visit(e);
  }
  template <class Visit>
  void for_each_up(std::uint32_t v, const Visit& visit) const {
    for (std::uint32_t e = nodes_[v].first[1]; e != kNone; e = edges_[e].next[1]) visit(e);
  }
  std::size_t memory_bytes() const;

 private:
  // The neighbours of a vertex in one of the two trees: `onward`, and the xor of the `count` ones on the other side.
  struct Link {
    std::uint32_t onward, others;
    std::uint32_t count;
  };
  struct Node {
    std::array<std::uint32_t, 2> first{kNone, kNone};  // its edges down and up
    std::array<std::uint32_t, 2> degree{0, 0};
  };
  struct Edge {
    std::array<std::uint32_t, 2> next{kNone, kNone};  // of the upper end's edges down, of the lower end's edges up
  };

  void place(const BoxSize& size, std::span<const std::uint32_t> order);
  void find_groups();
  void sweep(bool up);
  std::uint32_t find(std::uint32_t v);
  void merge();
  void remove_leaf(std::vector<Link>& own, std::vector<Link>& other, std::uint32_t v);
  void add_edge(std::uint32_t e, std::uint32_t lo, std::uint32_t hi);

  std::uint32_t count_ = 0;
  std::array<std::int32_t, 14> offsets_{};            // of the neighbours of a vertex, in padded_rank_
  std::vector<std::uint32_t> padded_rank_;            // by place in the box with a border of kNone
  std::vector<std::uint32_t> place_;                  // by rank
  std::vector<std::array<std::uint16_t, 2>> groups_;  // by rank: one neighbour of each group, below and above
  std::vector<std::uint32_t> parent_;                 // union-find
  std::vector<Link> join_, split_;
  std::vector<std::uint32_t> leaves_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;  // by the end that was removed first
};

}  // namespace reeb
