// The graph that a sweep takes down, before it is reduced to a fragment.
//
// Nodes are numbered in the order of the sweep, arcs by ascending lower node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/direction.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/engine/bucket_sums.h"
#include "libreeb/engine/chunk.h"
#include "libreeb/engine/chunk_stars.h"

namespace reeb {

struct SweepGraph {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // The arcs on one side of a node: whether there are any, or several, any on no path, any on some.
  struct Side {
    bool any = false, several = false, loose = false, tied = false;
  };
  struct Node {
    SweepKey key;               // once the sweep is over
    std::uint32_t vertex;       // its rank
    std::uint32_t main_branch;  // the arc up that every path takes for which no other is noted
    bool gone;                  // removed as noise, or contracted since
    Side up, down;
    bool near_noise;     // it has an arc that is short enough to be noise
    bool can_change;     // not a node of the final graph for certain
    bool lost_arcs;      // some of its arcs are settled
    std::uint32_t open;  // the number of the node in the fragment, or kNone
  };
  struct Arc {
    std::uint32_t lo, hi;  // nodes; lo == kNone: gone
    std::uint32_t open;    // the number of an open arc in the fragment
    bool referenced;

    std::uint32_t end(Direction d) const { return d == kUp ? hi : lo; }
  };
  // An extremum with one arc.
  struct Leaf {
    std::uint32_t node, arc;
  };
  std::vector<Node> nodes;
  std::vector<Arc> arcs;
  std::vector<Leaf> leaves;
  // The embedding, if there is one.
  std::vector<BucketLists::List> arc_buckets;
  BucketLists buckets;

  double length(const Arc& arc) const { return nodes[arc.hi].key.value - nodes[arc.lo].key.value; }

  void clear() {
    nodes.clear();
    arcs.clear();
    leaves.clear();
    arc_buckets.clear();
  }
  std::size_t memory_bytes() const {
    return nodes.capacity() * sizeof(Node) + arcs.capacity() * sizeof(Arc) + leaves.capacity() * sizeof(Leaf) +
           arc_buckets.capacity() * sizeof(BucketLists::List) + buckets.memory_bytes();
  }
};

// What the sweep ran over; order[r] is the local vertex of rank r.
struct SweptChunk {
  const Chunk& chunk;
  std::span<const double> values;
  std::span<const std::uint32_t> order;
  const ChunkStars& stars;

  std::uint8_t uses(std::uint32_t v) const { return chunk.uses[order[v]]; }
  double value(std::uint32_t v) const { return values[order[v]]; }
  SweepKey key(std::uint32_t v) const { return {values[order[v]], chunk.ids[order[v]]}; }
  Point position(std::uint32_t v) const { return chunk.positions.empty() ? Point{} : chunk.positions[order[v]]; }
};

}  // namespace reeb
