// The Reeb graph of one chunk, reduced to what the rest of the mesh can still change
// (docs/ARCHITECTURE.md, Why fragments are right). It replaces its chunk exactly.
//
// Open nodes are the chunk's vertices that other chunks use, whatever their degree, and the nodes that such vertices or
// shared edges can still change. A shared edge is a mesh edge that another chunk might have too. Its path is the
// monotone chain of arcs that it maps to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/graph/bucket_sums.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/port/graph_sink.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/sweep_options.h"

namespace reeb {

struct Fragment {
  SweepOptions options;
  std::size_t removed_pairs = 0;  // leaves that were removed as noise

  // Of a box of a grid, or of several: the faces that other boxes have, too. There are no shared edges then.
  BoxFaces shared_faces = 0;

  // Open nodes; of boxes ascending. A node that is used here only is complete from the start. A settled node cannot
  // change, and some of its arcs are already among the settled arcs; it is open because others are not.
  struct Node {
    SweepKey key;
    std::uint8_t uses = 0;  // VertexUse; of a box: the shared faces that it is on
    bool settled : 1 = false;
    // Set only if a monotone path leads from it down, or up, by kNoiseAhead times the threshold of noise or more. Not
    // in copies of a live graph, whose threshold may have risen since.
    bool far_down : 1 = false, far_up : 1 = false;
  };
  std::vector<Node> nodes;
  std::vector<Point> positions;  // one per node, or empty
  // Open arcs, by open nodes.
  struct Arc {
    FragmentNode lo, hi;
  };
  std::vector<Arc> arcs;
  // The embedding of the open arcs, or empty. Arc i owns buckets[bucket_begin[i] .. bucket_begin[i + 1]).
  std::vector<std::uint32_t> bucket_begin;
  std::vector<BucketSum> buckets;

  // Shared edges. The path of edge i is path_arcs[path_begin[i] .. path_begin[i + 1]), from above.
  struct SharedEdge {
    FragmentNode lo, hi;
  };
  std::vector<SharedEdge> edges;
  std::vector<std::uint32_t> path_begin;
  std::vector<FragmentArc> path_arcs;
  // Of a manifold: edges with two triangles in the chunk whose ends other chunks use. They need no path; a third
  // triangle is noticed by them.
  std::vector<SharedEdge> closed_edges;

  // The order of gluing: an edge is zipped after all its triangles, a vertex is completed after all its simplices.
  // Sorted by place.
  struct Step {
    std::uint32_t place;     // the index of the last of these triangles in the chunk
    std::uint32_t index;     // of an edge or a node
    bool completes = false;  // complete node `index`; otherwise zip edge `index`
  };
  std::vector<Step> steps;

  // Of a box of a grid: vertices that earlier boxes have, and no later ones, and that are no nodes here. `arc` passes
  // them.
  struct Passed {
    VertexId vertex;
    FragmentArc arc;
    double value;
    Point position;
  };
  std::vector<Passed> passed;

  // Nodes and arcs that nothing can change any more.
  std::vector<SettledNode> settled_nodes;
  std::vector<ArcKeys> settled_arcs;
  ArcLists settled_lists;  // their embedding, if there is one

  // Regular vertices that only this chunk has, if SweepOptions asks for them, with their index in `arcs` or in
  // `settled_arcs`; ascending.
  struct Regular {
    SweepKey vertex;
    std::uint32_t arc;
  };
  std::vector<Regular> on_open_arcs, on_settled_arcs;

  std::size_t triangle_count = 0;  // of the chunk

  // Passes the settled nodes and arcs on to the sink.
  void pass_settled_to(GraphSink& sink) const;
  std::size_t memory_bytes() const;
  void clear() {
    options = {};
    removed_pairs = 0;
    shared_faces = 0;
    nodes.clear();
    positions.clear();
    arcs.clear();
    bucket_begin.clear();
    buckets.clear();
    edges.clear();
    path_begin.clear();
    path_arcs.clear();
    closed_edges.clear();
    steps.clear();
    passed.clear();
    settled_nodes.clear();
    settled_arcs.clear();
    settled_lists.clear();
    on_open_arcs.clear();
    on_settled_arcs.clear();
    triangle_count = 0;
  }
};

}  // namespace reeb
