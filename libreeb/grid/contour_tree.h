// The contour tree of a box of grid vertices, or of two trees with nodes in common: the Reeb graph before regular
// vertices are left out.
//
// A box without holes is contractible, so its Reeb graph is a tree. That tree follows from two others (Carr, Snoeyink,
// Axen 2003): the join tree says how components of sublevel sets merge, the split tree how those of superlevel sets do.
// Each takes one union-find pass over the vertices. A table tells how the neighbours below (or above) a vertex of a box
// are connected, so a vertex costs one search for each group of them, not one for each neighbour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/sweep/chunk.h"

namespace reeb {

// Vertices are named by their ranks, and an edge of the tree by one of its ends.
//
// TIME: nearly linear. MEMORY: about 50 bytes per vertex, kept for the next box.
class ContourTree {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Arc {
    std::uint32_t lo, hi;
  };

  // `order[r]` is the vertex of rank r. REQUIRES: a box of at least one vertex.
  void build(const BoxSize& size, std::span<const std::uint32_t> order);
  // The tree with the join tree and the split tree of a graph of `count` vertices. REQUIRES: lo < hi < count.
  // THROWS: DamagedState if there is none.
  void build(std::uint32_t count, std::span<const Arc> arcs);

  // After the first build(): calls visit(v) for the vertices of a face of the box that are local extrema of the
  // function on the face alone.
  template <class Visit>
  void for_each_extremum_of_face(std::size_t axis, bool high, const Visit& visit) const;

  // The tree as a rooted one: vertices so that each comes after its parent, which is the first one's kNone. The edge to
  // the parent is named by the vertex itself.
  std::span<const std::uint32_t> from_root() const { return from_root_; }
  std::uint32_t parent(std::uint32_t v) const { return parent_[v]; }
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
  void list_neighbours(std::span<const Arc> arcs, bool below);
  template <class ForEachBefore>
  void sweep(bool up, const ForEachBefore& for_each_before);
  std::uint32_t find(std::uint32_t v);
  bool is_extremum_within(std::uint32_t place, unsigned neighbours) const;
  void merge();
  void remove_leaf(std::vector<Link>& own, std::vector<Link>& other, std::uint32_t v);
  void add_edge(std::uint32_t e, std::uint32_t lo, std::uint32_t hi);

  std::uint32_t count_ = 0;
  BoxSize size_{};
  std::array<std::int32_t, 14> offsets_{};            // of the neighbours of a vertex, in padded_rank_
  std::vector<std::uint32_t> padded_rank_;            // by place in the box with a border of kNone
  std::vector<std::uint32_t> place_;                  // by rank
  std::vector<std::array<std::uint16_t, 2>> groups_;  // by rank: one neighbour of each group, below and above
  std::vector<std::uint32_t> begin_, neighbours_;     // of arcs: neighbours on one side, by vertex
  std::vector<std::uint32_t> parent_;                 // of union-find; then in the tree
  std::vector<std::uint32_t> from_root_;
  std::vector<Link> join_, split_;
  std::vector<std::uint32_t> leaves_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;  // by the end that was removed first
};

template <class Visit>
void ContourTree::for_each_extremum_of_face(std::size_t axis, bool high, const Visit& visit) const {
  const std::array<std::uint32_t, 3> step{1, size_[0] + 2, (size_[0] + 2) * (size_[1] + 2)};
  unsigned within = 0;  // the neighbours that are in the plane of the face
  for (unsigned n = 0; n < 14; ++n)
    if (((n % 7 + 1) >> axis & 1) == 0) within |= 1u << n;
  const std::size_t a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  const std::uint32_t first = step[0] + step[1] + step[2] + (high ? (size_[axis] - 1) * step[axis] : 0);
  for (std::uint32_t j = 0; j < size_[b]; ++j)
    for (std::uint32_t i = 0; i < size_[a]; ++i)
      if (const std::uint32_t place = first + i * step[a] + j * step[b]; is_extremum_within(place, within))
        visit(padded_rank_[place]);
}

}  // namespace reeb
