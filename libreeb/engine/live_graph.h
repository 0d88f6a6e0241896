// The part of the Reeb graph that can still change: nodes, arcs, and the paths of mesh edges
// (the paper's section 2; docs/ARCHITECTURE.md, Why fragments are right). path_graph.h says how they are stored.
//
// Two paths with the same ends are zipped: their arcs are merged from above, and the shorter arc cuts the longer one. A
// node whose vertex is complete (all its simplices are in) is contracted when it has one arc up and one down. A
// complete node that can never come to that is settled. An arc without references whose ends are settled is written
// out. So of a bump on a long path only the fork stays here, not the arc to its top.
//
// Noise (docs/SEMANTICS.md, Noise removal): a leaf whose arc cannot change is removed once a search finds that its
// saddle has another path that reaches beyond the leaf. The searches are short; a last pass over the whole graph
// removes the leaves for which they do not suffice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/containers/growing_array.h"
#include "libreeb/engine/bead_chains.h"
#include "libreeb/engine/live_noise.h"
#include "libreeb/engine/path_graph.h"
#include "libreeb/graph/bucket_sums.h"
#include "libreeb/graph/direction.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/arc_log.h"
#include "libreeb/port/graph_sink.h"
#include "libreeb/port/settled_batch.h"
#include "libreeb/sweep/sweep_options.h"

namespace reeb {

class LiveGraph {
 public:
  using Index = PathGraph::Index;
  using State = PathGraph::State;
  static constexpr Index kNone = PathGraph::kNone;

  // Settled nodes and arcs go to `sink` when flush() is called, or before if they are many.
  LiveGraph(GraphSink& sink, bool track_positions)
      : sink_(&sink), track_positions_(track_positions), beads_(track_positions) {}
  // A copy of the graph alone: without positions, buckets and noise removal. REQUIRES: as save().
  LiveGraph(const LiveGraph& other, GraphSink& sink)
      : sink_(&sink),
        track_positions_(false),
        graph_(other.graph_),
        beads_(other.beads_, BeadChains::WithoutPositions{}) {}

  // As Glue::set_log(). Then there are no beads, since each arc has a number of its own in the log.
  void set_log(ArcLog& log) { log_ = &log; }
  // Sets the noise threshold and the width of buckets, for what follows.
  void set_options(const SweepOptions& options);

  Index add_node(const SweepKey& key, const Point& position, State state);
  // Notes that monotone paths lead far from the node, as Fragment::Node says.
  void set_far(Index node, bool down, bool up) {
    graph_.nodes[node].far_down |= down;
    graph_.nodes[node].far_up |= up;
  }
  Index add_arc(Index lo, Index hi);
  // To be called when a new arc has all the references of its fragment.
  void release(Index arc);
  // The embedding of an arc that was just added. REQUIRES: buckets of the exponent in the options.
  void add_buckets(Index arc, std::span<const BucketSum> buckets);
  const SweepKey& key(Index node) const { return graph_.nodes[node].key; }
  std::size_t node_slots() const { return graph_.nodes.size(); }  // more than the index of any node
  std::size_t arc_slots() const { return graph_.arcs.size(); }
  bool is_incomplete(Index node) const {
    return graph_.nodes[node].used && graph_.nodes[node].state == State::kIncomplete;
  }

  // Puts a reference on `arc` above the path that starts with `below` (kNone: nothing), and returns it. A path is named
  // by its top reference.
  Index add_reference(Index arc, Index below);
  // Reads what a zip reads of the arc of a reference, so that it is in the cache then; returns the next reference of
  // the path.
  Index prefetch(Index reference) const {
    const Index arc = graph_.references[reference].arc;
    const Node& node = graph_.nodes[graph_.arcs[arc].lo()];
    reeb::prefetch(&node.key);
    reeb::prefetch(&node.state);
    if (embeds_) buckets_.prefetch(arc_buckets_[arc]);
    return graph_.references[reference].down;
  }
  // Prefetches the position that tidy() reads when it contracts the node.
  void prefetch_position(Index node) const {
    if (embeds_ && track_positions_) reeb::prefetch(&positions_[node]);
  }
  // Merges two paths with the same ends into one. `a` stays a valid top, `b` does not.
  void zip(Index a, Index b);
  // Removes the references of the path that starts with `top`.
  void drop_path(Index top);
  // To be called when the node's vertex gets no further simplices. REQUIRES: no path starts or ends at it.
  void complete(Index node);
  // Contracts and settles the nodes that zips and complete() made ready for it. REQUIRES: not during a walk along a
  // path.
  void tidy();
  // Passes what has settled on to the sink.
  void flush();

  // The whole state, from which another process can continue. REQUIRES: the last calls were tidy() and flush().
  void save(StateWriter& out) const;
  // By reference: whether it is the top of a path.
  using PathTops = std::vector<bool>;
  // Returns the tops of all paths, for the owner of the paths to check.
  // THROWS: DamagedState unless the state can be continued from. Then this object must not be used.
  PathTops restore(StateReader& in);
  // Whether the path leads from `hi` down to `lo`.
  bool has_ends(Index top, Index lo, Index hi) const { return graph_.has_ends(top, lo, hi); }

  // Calls visit_node(node) for each node, and then visit_arc(arc, lo, hi) for each arc. REQUIRES: as save().
  template <class VisitNode, class VisitArc>
  void visit(const VisitNode& visit_node, const VisitArc& visit_arc) const {
    for (Index n = 0; n < graph_.nodes.size(); ++n)
      if (graph_.nodes[n].used) visit_node(n);
    for (Index a = 0; a < graph_.arcs.size(); ++a)
      if (!graph_.arcs[a].is_free()) visit_arc(a, graph_.arcs[a].lo(), graph_.arcs[a].hi());
  }
  // Calls visit(arc) for the arcs of the path that starts with `top`, from above.
  template <class Visit>
  void visit_path(Index top, const Visit& visit) const {
    for (; top != kNone; top = graph_.references[top].down) visit(graph_.references[top].arc);
  }
  // An arc with beads is a chain of arcs. Calls visit_bead(key, position) for each bead, from above, and before that
  // visit_bucket(bucket) for the buckets of the arc above it, ascending; in the end for those of the lowest arc.
  template <class VisitBead, class VisitBucket>
  void visit_chain(Index arc, const VisitBead& visit_bead, const VisitBucket& visit_bucket) const {
    if (embeds_) buckets_.visit(arc_buckets_[arc], visit_bucket);
    beads_.visit(graph_.arcs[arc].beads, [&](Index bead) {
      visit_bead(beads_.key(bead), beads_.position(bead));
      if (embeds_) buckets_.visit(beads_.buckets(bead), visit_bucket);
    });
  }
  State state(Index node) const { return graph_.nodes[node].state; }
  Point position(Index node) const { return track_positions_ ? positions_[node] : Point{}; }

  // Appends the arcs and isolated nodes of the present graph, without its (1, 1) nodes and without removed noise.
  void snapshot(std::vector<ArcKeys>& arcs, std::vector<SweepKey>& isolated) const;

  // More than the id of any node's vertex.
  std::uint64_t vertex_bound() const;
  std::size_t node_count() const { return graph_.nodes.used() + beads_.used(); }
  std::size_t arc_count() const { return graph_.arcs.used() + beads_.used(); }
  std::size_t bead_count() const { return beads_.used(); }
  std::size_t reference_count() const { return graph_.references.used(); }
  std::size_t bucket_count() const { return buckets_.used(); }
  std::size_t path_arc_count() const;                             // of all paths, with beads. O(live).
  std::uint64_t removed_pairs() const { return removed_pairs_; }  // leaves, so far
  std::uint64_t bead_steps() const { return bead_steps_; }        // beads that zips went over, one by one
  std::size_t memory_bytes() const;
  // What it takes in addition for this many more of each.
  std::size_t growth_bytes(std::size_t nodes, std::size_t arcs, std::size_t references, std::size_t buckets) const;

  // THROWS: std::logic_error that names the first inconsistency. O(live).
  void validate() const;

 private:
  using Node = PathGraph::Node;
  using Arc = PathGraph::Arc;

  PathTops check_restored();
  void check_restored_nodes();
  void check_restored_arcs();
  void grow_arc_buckets();
  void prefetch_buckets(Index a, Index b) const;
  void merge_parallel(Index keep, Index gone);
  void zip_beads(Index into, Index from, Index top, Index bottom);
  void cut(Index longer, Index shorter);
  void gained_reference(Index arc);
  void lost_references(Index arc);
  void queue(Index node);
  bool is_pass_through(const Node& n) const { return n.intact && n.degree(kUp) == 1 && n.degree(kDown) == 1; }
  bool stays_for_good(const Node& node) const;
  bool can_leave(Index arc) const;
  void remove_noise_at(Index node);
  void try_leaf(Index leaf);
  void add_path_buckets(Index arc, Direction d, double leaf);
  void move_buckets(Index arc, Index leaf, Direction d);
  bool is_bead(const Node& n) const;
  BucketLists::List& lowest_buckets(Index arc);
  Index join_arcs(Index node, BeadChains::Chain between);
  void contract(Index node);
  void make_bead(Index node);
  Index make_node(Index arc, Index bead, BeadChains::Chain above, BeadChains::Chain below);
  void release_beads(Index arc);
  void settle(Index node);
  void write_out(Index arc);
  void flush_if_many();

  GraphSink* sink_;
  ArcLog* log_ = nullptr;
  bool track_positions_;
  PathGraph graph_;
  GrowingArray<Point> positions_;  // one per node, if tracked
  BeadChains beads_;
  NearNoise noise_;
  bool embeds_ = false;
  BucketLists buckets_;
  // One per arc, if there is an embedding: of the arc, or from its upper end to its first bead.
  GrowingArray<BucketLists::List> arc_buckets_;
  std::vector<Index> path_;  // arcs, from the saddle of a leaf
  std::vector<PathBuckets> path_buckets_;
  std::uint64_t removed_pairs_ = 0, bead_steps_ = 0;
  std::vector<Index> changed_;       // complete nodes that tidy() has to examine
  std::vector<Index> unreferenced_;  // arcs whose beads it has to release
  SettledBatch settled_;
};

}  // namespace reeb
