// The Reeb graph of one chunk, reduced to what the rest of the mesh can still change
// (docs/ARCHITECTURE.md, Why fragments are right). It replaces its chunk exactly.
//
// Open nodes are the chunk's vertices that occur in other chunks, whatever their degree, and the
// nodes that such vertices or shared edges can still touch. A shared edge is a mesh edge that
// another chunk may have too; its path is the monotone chain of arcs that it maps to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/engine/bucket_sums.h"
#include "libreeb/engine/chunk.h"
#include "libreeb/engine/sweep_options.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

struct Fragment {
  SweepOptions options;
  std::size_t removed_pairs = 0;  // leaves that were removed as noise

  // Open nodes. A node that is used here only is complete from the start. Of a settled one some
  // arcs are among the settled arcs: it cannot change, and stays until its last arc has left.
  struct Node {
    SweepKey key;
    std::uint8_t uses = 0;  // VertexUse
    bool settled = false;
  };
  std::vector<Node> nodes;
  std::vector<Point> positions;  // one a node, or empty
  // Open arcs, by open nodes.
  struct Arc {
    FragmentNode lo, hi;
  };
  std::vector<Arc> arcs;
  // Their embedding, or empty; buckets of arc i: buckets[bucket_begin[i] .. bucket_begin[i + 1]).
  std::vector<std::uint32_t> bucket_begin;
  std::vector<BucketSum> buckets;

  // Shared edges; path of edge i: path_arcs[path_begin[i] .. path_begin[i + 1]), from above.
  struct SharedEdge {
    FragmentNode lo, hi;
  };
  std::vector<SharedEdge> edges;
  std::vector<std::uint32_t> path_begin;
  std::vector<FragmentArc> path_arcs;

  // In which order to glue: after all of an edge's triangles, zip it; after all of a vertex's
  // simplices, complete it. Sorted by place in the stream.
  struct Step {
    std::uint32_t place;     // in the chunk's stream of triangles
    std::uint32_t index;     // of an edge or a node
    bool completes = false;  // complete node `index`; otherwise zip edge `index`
  };
  std::vector<Step> steps;

  // What nothing can change any more.
  std::vector<SettledNode> settled_nodes;
  std::vector<ArcKeys> settled_arcs;
  std::vector<std::uint32_t> settled_bucket_counts;  // one an arc, or empty
  std::vector<Bucket> settled_buckets;

  std::size_t triangle_count = 0;  // of the chunk

  std::size_t memory_bytes() const;
  void clear() {
    options = {};
    removed_pairs = 0;
    nodes.clear();
    positions.clear();
    arcs.clear();
    bucket_begin.clear();
    buckets.clear();
    edges.clear();
    path_begin.clear();
    path_arcs.clear();
    steps.clear();
    settled_nodes.clear();
    settled_arcs.clear();
    settled_bucket_counts.clear();
    settled_buckets.clear();
    triangle_count = 0;
  }
};

}  // namespace reeb
