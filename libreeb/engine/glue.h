// Glues fragments, in stream order, to the live graph. The parallel pipeline and the on-line class both use it
// (docs/ARCHITECTURE.md, Why fragments are right).
//
// Why it is right: take the Reeb graphs of two chunks, make the nodes of equal vertices one node, and zip the two paths
// of every edge that both chunks have. That yields the Reeb graph of the union. A fragment has a path for every edge
// that another chunk can have. A path is dropped when one of its ends is complete, since then no later chunk can have
// the edge.
//
// TIME: O(fragment) plus the steps of the zips. MEMORY: proportional to the front.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/containers/flat_map.h"
#include "libreeb/containers/growing_array.h"
#include "libreeb/engine/live_graph.h"
#include "libreeb/port/arc_log.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/fragment.h"

namespace reeb {

class Glue {
 public:
  Glue(GraphSink& sink, bool track_positions) : sink_(&sink), graph_(sink, track_positions) {}
  // A copy that goes its own way: of the graph alone, without positions, buckets and noise removal. What is added to it
  // must have none of them either. O(live graph).
  Glue(const Glue& other, GraphSink& sink)
      : sink_(&sink),
        graph_(other.graph_, sink),
        node_of_(other.node_of_),
        edge_of_(other.edge_of_),
        edges_(other.edges_),
        links_(other.links_),
        first_free_edge_(other.first_free_edge_),
        first_link_(other.first_link_) {}

  // From now on the history of arcs goes to `log`, and fragments list their regular vertices.
  // REQUIRES: to be called before the first fragment; no noise is removed. `log` numbers arcs as the sink gets them.
  void set_log(ArcLog& log) {
    log_ = &log;
    graph_.set_log(log);
  }

  // Adds the next fragment of the stream.
  // REQUIRES: a vertex that it marks kUsedEarlier was marked kUsedLater in an earlier fragment, unless it is also
  // marked kUsedLater, or the fragment completes it; its options are not less than those of earlier fragments.
  // `grown` is told every few zips how many bytes are in use, since zips can make paths far longer than
  // memory_bytes_with() says.
  // THROWS: Error{kChanged} if a vertex has another value than in an earlier fragment: paths are monotone only if
  //         values stay the same.
  //         Error{kNotManifold} if the mesh was said to be a manifold, and is not.
  //         What `grown` throws; then the object must not be used any more.
  void add(const Fragment& fragment, const std::function<void(std::size_t bytes)>& grown = {});

  // Replaces `fragment` by all that is live: it can be added to another Glue, on its own terms. Incomplete vertices are
  // marked kUsedLater, shared edges are those between them; there are no steps and no options.
  // REQUIRES: no log is kept, and the fragments were no boxes.
  // THROWS: Error{kResource} if the paths have more than 2^32 arcs together, which a fragment cannot number.
  void copy_live(Fragment& fragment) const;
  // What that takes. O(live graph).
  std::size_t copy_bytes() const;
  // Says that no further fragment has this vertex. Does nothing if it is complete, or unknown.
  void complete(VertexId vertex);

  // The state so far, from which another process can continue. What was passed to the sink is not part of it.
  void save(StateWriter& out) const;
  // THROWS: DamagedState; then the object must not be used any more.
  void restore(StateReader& in);

  // Pairs that were removed as noise so far, here and in fragments.
  std::uint64_t removed_pairs() const { return removed_in_fragments_ + graph_.removed_pairs(); }
  const LiveGraph& graph() const { return graph_; }
  std::size_t live_vertices() const { return node_of_.size(); }
  std::size_t live_edges() const { return edge_of_.size(); }
  std::size_t live_arcs() const { return graph_.arc_count(); }
  std::uint64_t vertex_bound() const { return graph_.vertex_bound(); }  // more than the id of any node's vertex
  std::size_t memory_bytes() const;
  // The most that adding this fragment can make of it, apart from paths that zips make longer.
  std::size_t memory_bytes_with(const Fragment& fragment) const;

 private:
  using Index = LiveGraph::Index;
  static constexpr Index kNone = LiveGraph::kNone;

  // A mesh edge whose path is kept. Link 2e puts edge e in the list of its lower end, link 2e + 1 in the list of its
  // upper end.
  struct Edge {
    Index lo, hi;
    Index top;  // of its path; kNone if it has both triangles of a manifold; while free, the next free edge
  };
  struct Link {
    Index next, prev;
  };

  Index node(FragmentNode n) const { return nodes_[n.value()]; }
  void add_nodes(const Fragment& fragment);
  void grow_first_link(std::size_t nodes);
  void add_arcs(const Fragment& fragment);
  void add_paths(const Fragment& fragment);
  void add_closed_edges(const Fragment& fragment);
  Index add_path(const Fragment& fragment, std::size_t edge);
  Error third_triangle(Index lo, Index hi) const;
  void run_steps(const Fragment& fragment, const std::function<void(std::size_t)>& grown);
  void prefetch(std::span<const Fragment::Step> steps);
  void place_regular(const Fragment& fragment);
  void add_edge(Index lo, Index hi, Index top);
  void drop_edge(Index edge);
  void link(Index link, Index node);
  void unlink(Index link, Index node);
  void restore_nodes();
  void restore_edges(LiveGraph::PathTops tops);
  void complete_node(Index node);
  static std::uint64_t edge_key(Index lo, Index hi) { return std::uint64_t{hi} << 32 | lo; }

  GraphSink* sink_;
  ArcLog* log_ = nullptr;
  LiveGraph graph_;
  std::uint64_t removed_in_fragments_ = 0;
  FlatMap node_of_;  // incomplete vertices
  FlatMap edge_of_;  // by edge_key
  GrowingArray<Edge> edges_;
  GrowingArray<Link> links_;
  Index first_free_edge_ = kNone;
  GrowingArray<Index> first_link_;  // by node: its list of kept edges; without nodes that the graph made later

  std::vector<Index> nodes_, arcs_;  // of the current fragment
  struct Pending {
    Index edge = kNone;  // the live edge with which to zip
    Index top = kNone;   // of the fragment's path
  };
  std::vector<Pending> pending_;  // by shared edge of the fragment
  std::vector<Index> ahead_;      // where the paths are that prefetch() follows
};

}  // namespace reeb
