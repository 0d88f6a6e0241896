// The rules by which pairs are cancelled (docs/SEMANTICS.md, Cancelling), one step at a time.
//
// THREADS: a Canceller belongs to one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/path_follower.h"
#include "libreeb/hierarchy/path_search.h"
#include "libreeb/hierarchy/version_log.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// A cut of the arc `from`, which goes from `start` in `direction` to `end`, at `node`. The part before `node` goes to
// `into`.
struct ArcCut {
  Direction direction;
  ArcId from, into;
  NodeId start, node, end;
};

// A part of an arc: from `start` in `direction` to `end`.
struct ArcPart {
  Direction direction;
  ArcId arc;
  NodeId start, end;
};

inline constexpr std::uint32_t kAnyNumberOfArcs = ~std::uint32_t{0};

// Follows the content of arcs (an embedding, a count) while the rules move the arcs. Arcs are named by their numbers in
// the full graph; when two arcs become one, it has the number of one of them. cut and merge return whether they changed
// the content of `into`.
struct IgnoreContent {
  // Whether there is content. If so, the content of a removed arc is moved to another path where there is one, and an
  // arc whose content changes gets a new record.
  static constexpr bool kFollows = false;
  // The content of the arc of an extremum is moved to at most this many arcs; the rest is dropped. The path is walked
  // for this purpose only, and each arc on it gets a new record.
  static constexpr std::uint32_t kMostArcsOfExtremum = kAnyNumberOfArcs;
  // The part of `from` between `start` and `node` goes to `into`, which has these ends. The rest
  // stays.
  bool cut(const ArcCut& /*cut*/) { return false; }
  // The first value, in the direction of the part, at which cut() has anything to move; and whether a node is at that
  // value or beyond.
  double first_value(const ArcPart& /*part*/) { return 0; }
  bool is_reached(double /*value*/, Direction /*along*/, NodeId /*node*/) const { return false; }
  // Two arcs with the same ends: the content of `from` goes to `into`.
  bool merge(ArcId /*from*/, ArcId /*into*/) { return false; }
  // `lower` ends where `upper` starts, at a node that is contracted; `lower` becomes both.
  void join(ArcId /*upper*/, ArcId /*lower*/, NodeId /*node*/) {}
  // `arc`, which leads to an extremum in this direction, becomes part of `other`, which goes on beyond it.
  void lay(ArcId /*arc*/, ArcId /*other*/, NodeId /*extremum*/, Direction /*direction*/) {}
  // The arc is removed, with this number of nodes; its content is dropped.
  void drop(ArcId /*arc*/, std::uint32_t /*nodes*/) {}
  // The content that the arc had before this step, in the form of a record.
  std::span<const std::byte> before_step(ArcId /*arc*/) const { return {}; }
  // Ends the step.
  void commit() {}
  // For the prefetches of the Canceller: a node; where the content of an arc is stored; the content.
  void prefetch_node(NodeId /*node*/) const {}
  void prefetch_place(ArcId /*arc*/) const {}
  void prefetch(ArcId /*arc*/) const {}
};

// MEMORY: 40 bytes per arc and 33 bytes per node.
template <class Content = IgnoreContent, class Graph = WorkingGraph>
class Canceller {
 public:
  // REQUIRES: `sink` outlives this.
  Canceller(Graph graph, RecordSink& sink, Content content = {})
      : graph_(std::move(graph)), log_(graph_, sink), search_(graph_), ways_(graph_), content_(std::move(content)) {}
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
    log_.commit(content_);
    return true;
  }

  // Prefetch what cancelling a pair reads: its nodes; their nearest arcs; the far ends of these, and the arcs below
  // them in their heaps; the arcs at these far ends, and the far ends of the arcs below; the arcs there. Call them in
  // this order, each for a pair some turns before the next call for it: each reads what the one before has fetched.
  void prefetch_nodes(const PersistencePair& pair) const {
    for (const NodeId id : {pair.lo, pair.hi}) {
      prefetch_node(id);
      search_.prefetch(id);
    }
  }
  void prefetch_arcs(const PersistencePair& pair) const {
    for_nearest(pair, [&](ArcId arc, Direction /*d*/) { prefetch_arc(arc); });
  }
  void prefetch_neighbours(const PersistencePair& pair) const {
    for_nearest(pair, [&](ArcId arc, Direction d) {
      prefetch_node(graph_.end(arc, d));
      content_.prefetch(arc);
    });
    for_next(pair, [&](ArcId arc, Direction /*d*/) { prefetch_arc(arc); });
  }
  void prefetch_next(const PersistencePair& pair) const {
    for_nearest(pair, [&](ArcId arc, Direction d) { graph_.prefetch_arcs(graph_.end(arc, d)); });
    for_next(pair, [&](ArcId arc, Direction d) {
      prefetch_node(graph_.end(arc, d));
      content_.prefetch(arc);
    });
  }
  void prefetch_beyond(const PersistencePair& pair) const {
    for_next(pair, [&](ArcId arc, Direction d) { graph_.prefetch_arcs(graph_.end(arc, d)); });
  }

  const Graph& graph() const { return graph_; }
  const Content& content() const { return content_; }
  // Writes the records of the last version. REQUIRES: nothing is cancelled afterwards.
  void finish() { log_.finish(content_); }

 private:
  static constexpr ArcId kNone = Graph::kNone;
  static constexpr std::uint32_t kAny = kAnyNumberOfArcs;

  // A pair of `fork` with the extremum that is its partner in direction d.
  void cancel_extremum(Direction d, NodeId fork, NodeId extremum) {
    const auto [in, out] = search_.arcs_of_fork(d, fork, extremum);
    zip_onto(d, in, out, extremum);
  }
  void zip_onto(Direction d, ArcId arc, ArcId other, NodeId extremum);
  bool follow_in_parallel(Direction d, ArcId arc, ArcId& other, NodeId& start, NodeId end, std::uint32_t most = kAny);
  bool cancel_loop(NodeId v, NodeId y);
  void take_away(ArcId arc);

  void prefetch_node(NodeId node) const {
    graph_.prefetch_node(node);
    ways_.prefetch(node);
    content_.prefetch_node(node);
  }
  void prefetch_arc(ArcId arc) const {
    graph_.prefetch_arc(arc);
    log_.prefetch(arc);
    content_.prefetch_place(arc);
  }
  // Calls visit(arc, d) for the nearest arc of each node of the pair in each direction.
  template <class Visit>
  void for_nearest(const PersistencePair& pair, const Visit& visit) const {
    for (const NodeId node : {pair.lo, pair.hi})
      for (const Direction d : {kDown, kUp})
        if (const ArcId arc = graph_.nearest(node, d); arc != kNone) visit(arc, d);
  }
  // The same for the arcs below these in their heaps. A node of three arcs has no others.
  template <class Visit>
  void for_next(const PersistencePair& pair, const Visit& visit) const {
    for_nearest(pair, [&](ArcId nearest, Direction d) {
      for (const ArcId arc : graph_.below_in_heap(nearest, d))
        if (arc != kNone) visit(arc, d);
    });
  }

  // Zips the two paths, which go in direction d.
  void zip(Direction d);
  void move_start(Direction d, ArcId arc, NodeId node) {
    log_.touch(arc);
    note_ends(arc);
    graph_.move_end(arc, opposite(d), node);
    ways_.note(node, d);
  }
  void remove(ArcId arc) {
    log_.touch(arc);
    note_ends(arc);
    graph_.remove(arc);
  }
  void note_ends(ArcId arc) {
    ways_.note(graph_.end(arc, kDown), kUp);
    ways_.note(graph_.end(arc, kUp), kDown);
  }
  void cut(Direction d, ArcId from, ArcId into, NodeId node) {
    if (content_.cut({d, from, into, graph_.end(from, opposite(d)), node, graph_.end(from, d)})) log_.touch(into);
    move_start(d, from, node);
  }
  void merge(ArcId from, ArcId into) {
    if (content_.merge(from, into)) log_.touch(into);
    remove(from);
  }
  void contract(NodeId node);

  Graph graph_;
  VersionLog<Graph> log_;
  PathSearch<Graph> search_;
  PathFollower<Graph> ways_;
  TwoPaths paths_;  // to be zipped
  Content content_;
};

// ---- extrema

// Zips the path that starts with `arc` and ends in the extremum onto the path that starts with `other`, which is in
// another component and reaches beyond. An arc of the second path is cut only where a node of the first path comes
// between its ends. An extremum with a single arc does not count as such a node: it is removed with its arc.
template <class Content, class Graph>
void Canceller<Content, Graph>::zip_onto(Direction d, ArcId arc, ArcId other, NodeId extremum) {
  NodeId start = graph_.end(arc, opposite(d));  // before it the two paths are already one
  while (true) {
    const NodeId end = graph_.end(arc, d);
    const ArcId next = graph_.nearest(end, d);
    if (end == extremum && graph_.has_one(extremum, opposite(d))) break;
    follow_in_parallel(d, arc, other, start, end);
    if (graph_.end(arc, opposite(d)) != start) move_start(d, arc, start);
    cut(d, other, arc, end);
    if (end == extremum) return;
    start = end;
    arc = next;
  }
  if constexpr (Content::kFollows) {
    if (follow_in_parallel(d, arc, other, start, extremum, Content::kMostArcsOfExtremum)) {
      log_.touch(other);
      content_.lay(arc, other, extremum, d);
    } else {
      content_.drop(arc, 1);
    }
  }
  remove(arc);
}

// Follows the second path from `start` until its arc `other` reaches `end` or beyond, and moves the content of `arc` to
// the arcs that are passed. False if there are more than `most` of them.
template <class Content, class Graph>
bool Canceller<Content, Graph>::follow_in_parallel(Direction d, ArcId arc, ArcId& other, NodeId& start, NodeId end,
                                                   std::uint32_t most) {
  ArcPart left{d, arc, start, end};  // the part whose content was not moved yet
  double first = content_.first_value(left);
  for (NodeId node = graph_.end(other, d); along(d, node) < along(d, end); node = graph_.next(start, d)) {
    if (most != kAny && most-- == 0) return false;
    if (content_.is_reached(first, d, node)) {
      if (content_.cut({d, arc, other, left.start, node, end})) log_.touch(other);
      left.start = node;
      first = content_.first_value(left);
    }
    start = most != kAny ? node : ways_.follow(node, d, [&](NodeId next) {
      return along(d, next) < along(d, end) && !content_.is_reached(first, d, next);
    });
    other = graph_.nearest(start, d);
  }
  return true;
}

// ---- loops

template <class Content, class Graph>
bool Canceller<Content, Graph>::cancel_loop(NodeId v, NodeId y) {
  if (const ArcId arc = search_.find_arc(v, y); arc != kNone) {
    take_away(arc);
    return true;
  }
  if (!search_.find_paths(v, y, paths_)) return false;
  zip(kUp);
  return true;
}

template <class Content, class Graph>
void Canceller<Content, Graph>::take_away(ArcId arc) {
  if constexpr (Content::kFollows) {
    if (search_.find_path_beside(arc, paths_.first)) {
      paths_.second.assign(1, arc);
      return zip(kUp);
    }
    content_.drop(arc, 0);
  }
  remove(arc);
}

// ---- moving arcs

template <class Content, class Graph>
void Canceller<Content, Graph>::zip(Direction d) {
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

template <class Content, class Graph>
void Canceller<Content, Graph>::contract(NodeId node) {
  if (!graph_.is_regular(node)) return;
  const ArcId lower = graph_.nearest(node, kDown), upper = graph_.nearest(node, kUp);
  const NodeId end = graph_.end(upper, kUp);
  content_.join(upper, lower, node);
  remove(upper);
  move_start(kDown, lower, end);
}

}  // namespace reeb
