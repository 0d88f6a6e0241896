// The graph that a sweep records, before it is reduced to a fragment.
//
// Nodes are numbered in the order of the sweep, arcs by ascending lower node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/sweep_key.h"
#include "libreeb/containers/id_vector.h"
#include "libreeb/graph/bucket_sums.h"
#include "libreeb/graph/direction.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/chunk_stars.h"

namespace reeb {

struct SweepGraph {
  // The arcs on one side of a node: whether there is one, whether there are several, whether one of them is on no path
  // (loose), and whether one of them is on a path (tied).
  struct Side {
    bool any = false, several = false, loose = false, tied = false;
  };
  struct Node {
    SweepKey key{};                            // set when the sweep is over, as are the uses
    VertexRank vertex;                         // its vertex
    SweepArc main_branch = SweepArc::none();   // the arc up that a path takes unless another one is noted for it
    FragmentNode open = FragmentNode::none();  // its id in the fragment, or none()
    std::uint8_t uses = 0;                     // of its vertex, as in Chunk
    bool gone = false;                         // removed as noise, or contracted
    Side up{}, down{};
    bool near_noise = false;  // it has an arc that might become a leaf's, and noise
    bool can_change = false;  // not certain to be a node of the final graph
    bool lost_arcs = false;   // some of its arcs are settled; of boxes, some may have been before the sweep
  };
  struct Arc {
    SweepNode lo, hi;  // lo == none(): gone
    FragmentArc
        open;         // its id in the fragment, if it is open; if it is gone: the arc that it is now part of, or none()
    bool referenced;  // by the path of a shared edge

    SweepNode end(Direction d) const { return d == kUp ? hi : lo; }
    bool gone() const { return lo == SweepNode::none(); }
    // Says that this arc is now part of another.
    void join(SweepArc other) {
      lo = SweepNode::none();
      open = FragmentArc(other.value());
    }
  };
  // An extremum with one arc.
  struct Leaf {
    SweepNode node;
    SweepArc arc;
  };
  IdVector<SweepNode, Node> nodes;
  IdVector<SweepArc, Arc> arcs;
  std::vector<Leaf> leaves;
  // The embedding, if there is one.
  IdVector<SweepArc, BucketLists::List> arc_buckets;
  BucketLists buckets;

  // The arc that `arc` is now part of.
  SweepArc present(SweepArc arc) const {
    while (arcs[arc].gone()) arc = SweepArc(arcs[arc].open.value());
    return arc;
  }
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

// The input of a sweep; order[r] is the local vertex of rank r.
struct SweptChunk {
  const Chunk& chunk;
  std::span<const double> values;
  std::span<const std::uint32_t> order;
  const ChunkStars* stars;  // null: of a box, or of a union of boxes

  LocalVertex local(VertexRank v) const { return LocalVertex(order[v.value()]); }
  std::uint8_t uses(VertexRank v) const { return chunk.uses[local(v).value()]; }
  double value(VertexRank v) const { return values[local(v).value()]; }
  SweepKey key(VertexRank v) const { return {value(v), chunk.ids[local(v).value()]}; }
  // The place of the last triangle that uses v.
  std::uint32_t last_place(VertexRank v) const { return stars->last_place(v.value()); }
  // The rank of the first vertex above v that is not in the bucket of this index.
  std::uint32_t end_of_bucket(std::uint32_t v, std::int64_t index, int exponent) const;
  Point position(VertexRank v) const { return chunk.position(local(v)); }
};

}  // namespace reeb
