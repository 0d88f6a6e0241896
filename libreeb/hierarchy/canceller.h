// The rules by which pairs are cancelled (docs/SEMANTICS.md, Cancelling), one step at a time.
//
// THREADS: a Canceller belongs to one thread, except that deferred changes may be made in another one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/containers/id_vector.h"
#include "libreeb/containers/kept_ids.h"
#include "libreeb/hierarchy/arc_changes.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/path_follower.h"
#include "libreeb/hierarchy/path_search.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// MEMORY: 36 bytes per arc and 33 bytes per node; after compact(), 4 more for each that is left.
template <class Content = IgnoreContent, class Graph = WorkingGraph,
          template <class, class> class ChangesKind = ArcChanges>
class Canceller {
 public:
  using Changes = ChangesKind<Content, Graph>;

  // REQUIRES: `sink` outlives this.
  Canceller(Graph graph, RecordSink& sink, Content content = {})
      : graph_(std::move(graph)), search_(graph_), ways_(graph_), changes_(graph_, sink, std::move(content)) {}
  Canceller(const Canceller&) = delete;
  Canceller& operator=(const Canceller&) = delete;

  // Cancels the pair, which makes a version. For a loop that no rule can cancel it changes nothing and returns false.
  // REQUIRES: called in the order of cancelling, for all pairs but Ext0.
  bool cancel(const PersistencePair& pair) {
    const NodeId lo = pair.lo, hi = pair.hi;
    if (pair.type == PairType::kRel1) cancel_extremum(kUp, lo, hi);
    if (pair.type == PairType::kOrd0) cancel_extremum(kDown, hi, lo);
    if (pair.type == PairType::kExt1 && !cancel_loop(lo, hi)) {
      search_.note_kept(lo, hi);
      return false;
    }
    contract(lo);
    contract(hi);
    ways_.apply_changes();
    changes_.commit();
    return true;
  }

  // Prefetch what cancelling a pair reads: its nodes; their nearest arcs with their far ends; the arcs at these, and
  // the arcs below the nearest ones in their heaps; the far ends of the arcs below; the arcs there. Call them in this
  // order, each for a pair some turns before the next call for it: each reads what the one before has fetched.
  void prefetch_nodes(const PersistencePair& pair) const {
    for (const NodeId id : {pair.lo, pair.hi}) {
      prefetch_node(id);
      search_.prefetch(id);
    }
  }
  void prefetch_arcs(const PersistencePair& pair) const {
    for_nearest(pair, [&](ArcId arc, NodeId end, Direction /*d*/) {
      prefetch_arc(arc);
      prefetch_node(end);
    });
  }
  void prefetch_neighbours(const PersistencePair& pair) const {
    for_nearest(pair, [&](ArcId arc, NodeId end, Direction /*d*/) {
      graph_.prefetch_arcs(end);
      changes_.prefetch_content(full(arc));
    });
    for_next(pair, [&](ArcId arc, Direction /*d*/) { prefetch_arc(arc); });
  }
  void prefetch_next(const PersistencePair& pair) const {
    for_next(pair, [&](ArcId arc, Direction d) {
      prefetch_node(graph_.end(arc, d));
      changes_.prefetch_content(full(arc));
    });
  }
  void prefetch_beyond(const PersistencePair& pair) const {
    for_next(pair, [&](ArcId arc, Direction d) { graph_.prefetch_arcs(graph_.end(arc, d)); });
  }
  // Content is moved along the paths beside a pair of a fork and an extremum. Prefetches the node of such a path after
  // this many others. To be called with 1, 2, 3 and so on, after the stages above.
  void prefetch_path(const PersistencePair& pair, std::size_t nodes) const {
    if constexpr (!Content::kFollows) return;
    if (pair.type != PairType::kRel1 && pair.type != PairType::kOrd0) return;
    const Direction d = pair.type == PairType::kRel1 ? kUp : kDown;
    const auto [fork, extremum] = d == kUp ? std::pair(pair.lo, pair.hi) : std::pair(pair.hi, pair.lo);
    const ArcId nearest = graph_.nearest(fork, d);
    if (nearest == kNone) return;
    for (const ArcId arc : {nearest, graph_.below_in_heap(nearest, d)[0]}) {
      if (arc == kNone) continue;
      const auto is_beside = [&](NodeId node) { return node != NodeId::none() && along(d, node) < along(d, extremum); };
      NodeId node = graph_.end(arc, d);
      for (std::size_t i = 0; i < nodes && is_beside(node); ++i) node = graph_.next(node, d);
      if (is_beside(node)) graph_.prefetch_node(node);
    }
  }

  const Graph& graph() const { return graph_; }
  const Content& content() const { return changes_.content(); }
  Changes& changes() { return changes_; }

  // Gives the nodes and arcs that are left their ranks as numbers, so that they are near each other in memory. From
  // then on, pairs are given in these numbers. Returns the nodes that are left. The records are the same. REQUIRES:
  // there is content.
  KeptIds compact() {
    typename Graph::Left left = graph_.compact();
    search_.renumber(left.nodes);
    ways_.restart();
    keep_full(full_nodes_, left.nodes);
    keep_full(full_arcs_, left.arcs);
    return std::move(left.nodes);
  }

  // Writes the records of the last version. REQUIRES: nothing is cancelled afterwards.
  void finish() {
    std::vector<ArcId> arcs;
    for (ArcId arc; arc < graph_.end_arc(); ++arc)
      if (graph_.alive(arc)) arcs.push_back(arc);
    changes_.finish(std::move(arcs), [this](ArcId arc) { return LivingArc{full(arc), full_ends(arc)}; });
  }

 private:
  static constexpr ArcId kNone = Graph::kNone;
  static constexpr std::uint32_t kAny = kAnyNumberOfArcs;

  // A pair of `fork` with the extremum that is its partner in direction d.
  void cancel_extremum(Direction d, NodeId fork, NodeId extremum) {
    const auto [in, out] = search_.arcs_of_fork(d, fork, extremum);
    zip_onto(d, in, out, fork, extremum);
  }
  void zip_onto(Direction d, ArcId arc, ArcId other, NodeId start, NodeId extremum);
  bool note_in_parallel(Direction d, ArcId arc, ArcId& other, NodeId& start, NodeId end, std::uint32_t most);
  bool follow_in_parallel(Direction d, ArcId arc, ArcId& other, NodeId& start, NodeId end, std::uint32_t most = kAny);
  bool cancel_loop(NodeId v, NodeId y);
  void take_away(ArcId arc);

  void prefetch_node(NodeId node) const {
    graph_.prefetch_node(node);
    ways_.prefetch(node);
    changes_.prefetch_node(full(node));
  }
  void prefetch_arc(ArcId arc) const {
    graph_.prefetch_arc(arc);
    changes_.prefetch_place(full(arc));
  }
  // Calls visit(arc, far end, d) for the nearest arc of each node of the pair in each direction d.
  template <class Visit>
  void for_nearest(const PersistencePair& pair, const Visit& visit) const {
    for (const NodeId node : {pair.lo, pair.hi})
      for (const Direction d : {kDown, kUp})
        if (const ArcId arc = graph_.nearest(node, d); arc != kNone) visit(arc, graph_.next(node, d), d);
  }
  // Calls visit(arc, d) for the arcs below these in their heaps. A node of three arcs has no others.
  template <class Visit>
  void for_next(const PersistencePair& pair, const Visit& visit) const {
    for_nearest(pair, [&](ArcId nearest, NodeId /*end*/, Direction d) {
      for (const ArcId arc : graph_.below_in_heap(nearest, d))
        if (arc != kNone) visit(arc, d);
    });
  }

  // Zips the two paths, which go in direction d.
  void zip(Direction d);

  // The number in the full graph, by which changes_ knows a node or an arc.
  NodeId full(NodeId node) const { return full_nodes_.empty() ? node : full_nodes_[node]; }
  ArcId full(ArcId arc) const { return full_arcs_.empty() ? arc : full_arcs_[arc]; }
  ArcEnds full_ends(ArcId arc) const { return {full(graph_.end(arc, kDown)), full(graph_.end(arc, kUp))}; }
  template <class Id>
  static void keep_full(IdVector<Id, Id>& full, const KeptIds& kept) {
    IdVector<Id, Id> left;
    left.reserve(kept.count());
    for (std::uint32_t id = 0; left.size() < kept.count(); ++id)
      if (kept.has(id)) left.add(full.empty() ? Id(id) : full[Id(id)]);
    full = std::move(left);
  }

  // REQUIRES: changes_ was told of it.
  void move_start(Direction d, ArcId arc, NodeId node) {
    note_ends(arc);
    graph_.move_end(arc, opposite(d), node);
    ways_.note(node, d);
  }
  void remove(ArcId arc) {
    note_ends(arc);
    graph_.remove(arc);
  }
  void note_ends(ArcId arc) {
    ways_.note(graph_.end(arc, kDown), kUp);
    ways_.note(graph_.end(arc, kUp), kDown);
  }
  void cut(Direction d, ArcId from, ArcId into, NodeId node) {
    const NodeId start = graph_.end(from, opposite(d)), end = graph_.end(from, d);
    changes_.cut({d, full(from), full(into), full(start), full(node), full(end)}, full_ends(into));
    move_start(d, from, node);
  }
  void merge(ArcId from, ArcId into) {
    changes_.merge(full(from), full(into), full_ends(into));
    remove(from);
  }
  void contract(NodeId node);

  Graph graph_;
  PathSearch<Graph> search_;
  PathFollower<Graph> ways_;
  TwoPaths paths_;  // to be zipped
  Changes changes_;
  IdVector<NodeId, NodeId> full_nodes_;  // empty if the numbers are those of the full graph
  IdVector<ArcId, ArcId> full_arcs_;
};

// ---- extrema

// Zips the path that starts with `arc` and ends in the extremum onto the path that starts with `other`, which is in
// another component and reaches beyond. An arc of the second path is cut only where a node of the first path comes
// between its ends. An extremum with a single arc does not count as such a node: it is removed with its arc. Before
// `start` the two paths are already one.
template <class Content, class Graph, template <class, class> class ChangesKind>
void Canceller<Content, Graph, ChangesKind>::zip_onto(Direction d, ArcId arc, ArcId other, NodeId start,
                                                      NodeId extremum) {
  while (true) {
    const NodeId end = graph_.end(arc, d);
    const ArcId next = graph_.nearest(end, d);
    if (end == extremum && graph_.has_one(extremum, opposite(d))) break;
    follow_in_parallel(d, arc, other, start, end);
    if (graph_.end(arc, opposite(d)) != start) {
      changes_.touch(full(arc), full_ends(arc));
      move_start(d, arc, start);
    }
    cut(d, other, arc, end);
    if (end == extremum) return;
    start = end;
    arc = next;
  }
  bool goes_beside = false;
  if constexpr (Content::kFollows)
    goes_beside = follow_in_parallel(d, arc, other, start, extremum, Content::kMostArcsOfExtremum);
  if (goes_beside)
    changes_.lay(full(arc), full_ends(arc), full(other), full_ends(other), d);
  else
    changes_.drop(full(arc), full_ends(arc), 1);
  remove(arc);
}

// Follows the second path from `start` until its arc `other` reaches `end` or beyond, and moves the content of `arc` to
// the arcs that are passed. False, with `other` and `start` as they were, if there are more than `most` of them.
template <class Content, class Graph, template <class, class> class ChangesKind>
bool Canceller<Content, Graph, ChangesKind>::follow_in_parallel(Direction d, ArcId arc, ArcId& other, NodeId& start,
                                                                NodeId end, std::uint32_t most) {
  if (along(d, graph_.end(other, d)) >= along(d, end)) return true;  // no arc is passed

  ArcPart left{d, full(arc), full(start), full(end)};  // the part whose content was not moved yet
  if constexpr (Changes::kDefers) {
    if (!changes_.begin_known_path(left)) {
      if (note_in_parallel(d, arc, other, start, end, most)) return true;
      if (most != kAny) return false;
      changes_.begin_long_path(left);
    }
  }
  ArcId passed = other;
  NodeId from = start;
  double first = changes_.first_value(left);
  for (NodeId node = graph_.end(passed, d); along(d, node) < along(d, end); node = graph_.next(from, d)) {
    if (most != kAny && most-- == 0) return false;
    if (changes_.is_reached(first, d, full(node))) {
      changes_.cut_content({d, left.arc, full(passed), left.start, full(node), left.end}, full_ends(passed));
      left.start = full(node);
      first = changes_.first_value(left);
    }
    from = most != kAny ? node : ways_.follow(node, d, [&](NodeId next) {
      return along(d, next) < along(d, end) && !changes_.is_reached(first, d, full(next));
    });
    passed = graph_.nearest(from, d);
  }
  other = passed;
  start = from;
  return true;
}

// Notes the path arc by arc, for changes that are deferred. False if there are more than `most` of them, or it is long.
template <class Content, class Graph, template <class, class> class ChangesKind>
bool Canceller<Content, Graph, ChangesKind>::note_in_parallel(Direction d, ArcId arc, ArcId& other, NodeId& start,
                                                              NodeId end, std::uint32_t most) {
  changes_.begin_path({d, full(arc), full(start), full(end)});
  ArcId passed = other;
  NodeId from = start;
  std::uint32_t arcs = 0;
  for (NodeId node = graph_.end(passed, d); along(d, node) < along(d, end); node = graph_.next(from, d)) {
    ++arcs;
    if (most == kAny && changes_.is_long_path(arcs)) {
      changes_.forget_path();
      return false;
    }
    if (arcs > most) {
      changes_.end_path();
      return false;
    }
    changes_.pass(d, full(passed), full_ends(passed));
    from = node;
    passed = graph_.nearest(from, d);
  }
  changes_.end_path();
  other = passed;
  start = from;
  return true;
}

// ---- loops

template <class Content, class Graph, template <class, class> class ChangesKind>
bool Canceller<Content, Graph, ChangesKind>::cancel_loop(NodeId v, NodeId y) {
  if (const ArcId arc = search_.find_arc(v, y); arc != kNone) {
    take_away(arc);
    return true;
  }
  if (!search_.find_paths(v, y, paths_)) return false;
  zip(kUp);
  return true;
}

template <class Content, class Graph, template <class, class> class ChangesKind>
void Canceller<Content, Graph, ChangesKind>::take_away(ArcId arc) {
  if constexpr (Content::kFollows) {
    if (search_.find_path_beside(arc, paths_.first)) {
      paths_.second.assign(1, arc);
      return zip(kUp);
    }
  }
  changes_.drop(full(arc), full_ends(arc), 0);
  remove(arc);
}

// ---- moving arcs

template <class Content, class Graph, template <class, class> class ChangesKind>
void Canceller<Content, Graph, ChangesKind>::zip(Direction d) {
  for (std::size_t i = 0, j = 0; i < paths_.first.size() && j < paths_.second.size();) {
    const ArcId a = paths_.first[i], b = paths_.second[j];
    const NodeId end_a = graph_.end(a, d), end_b = graph_.end(b, d);
    if (end_a == end_b) {
      merge(b, a);
      ++i, ++j;
    } else if (along(d, end_a) < along(d, end_b)) {
      cut(d, b, a, end_a);
      ++i;
    } else {
      cut(d, a, b, end_b);
      ++j;
    }
  }
}

template <class Content, class Graph, template <class, class> class ChangesKind>
void Canceller<Content, Graph, ChangesKind>::contract(NodeId node) {
  if (!graph_.is_regular(node)) return;
  const ArcId lower = graph_.nearest(node, kDown), upper = graph_.nearest(node, kUp);
  const NodeId end = graph_.end(upper, kUp);
  changes_.join({full(upper), full(lower), full(graph_.end(lower, kDown)), full(node), full(end)});
  remove(upper);
  move_start(kDown, lower, end);
}

}  // namespace reeb
