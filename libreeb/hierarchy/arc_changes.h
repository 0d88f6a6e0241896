// What becomes of the arcs while the rules of cancelling move them: where their content goes, and when their records
// end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/graph/direction.h"
#include "libreeb/graph/reeb_graph.h"
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

// Two arcs that become one, `lower`, from `lo` to `hi`. They meet at `node`, which is contracted.
struct ArcJoin {
  ArcId upper, lower;
  NodeId lo, node, hi;
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
  // The part of `from` between `start` and `node` goes to `into`. The rest stays.
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
  // Prefetch a node; where the content of an arc is stored; the content.
  void prefetch_node(NodeId /*node*/) const {}
  void prefetch_place(ArcId /*arc*/) const {}
  void prefetch(ArcId /*arc*/) const {}
};

// Writes the changes at once. Ends of an arc are those that it has when the function is called.
//
// MEMORY: as VersionLog and the content.
template <class ContentKind, class Graph>
class ArcChanges {
 public:
  using Content = ContentKind;
  // Whether it only notes what is to be written later (deferred_changes.h).
  static constexpr bool kDefers = false;

  // REQUIRES: `graph` and `sink` outlive this.
  ArcChanges(const Graph& graph, RecordSink& sink, Content content) : log_(graph, sink), content_(std::move(content)) {}

  Content& content() { return content_; }
  const Content& content() const { return content_; }

  // The arc is to be moved, or removed without regard to its content.
  void touch(ArcId arc, const ArcEnds& ends) { log_.touch(arc, ends); }

  // A part of the content of `from` is moved, but not yet the arc.
  void cut_content(const ArcCut& cut, const ArcEnds& ends_of_into) {
    if (content_.cut(cut)) log_.touch(cut.into, ends_of_into);
  }

  // Each of these is done to the content, as IgnoreContent says. The arcs that it moves or removes are touched.
  void cut(const ArcCut& cut, const ArcEnds& ends_of_into) {
    cut_content(cut, ends_of_into);
    log_.touch(cut.from, ends_along(cut.direction, cut.start, cut.end));
  }
  double first_value(const ArcPart& part) { return content_.first_value(part); }
  bool is_reached(double value, Direction d, NodeId node) const { return content_.is_reached(value, d, node); }
  void merge(ArcId from, ArcId into, const ArcEnds& ends_of_both) {
    if (content_.merge(from, into)) log_.touch(into, ends_of_both);
    log_.touch(from, ends_of_both);
  }
  void join(const ArcJoin& join) {
    content_.join(join.upper, join.lower, join.node);
    log_.touch(join.upper, {join.node, join.hi});
    log_.touch(join.lower, {join.lo, join.node});
  }
  // The extremum is the end of the arc in direction d.
  void lay(ArcId arc, const ArcEnds& ends, ArcId other, const ArcEnds& ends_of_other, Direction d) {
    content_.lay(arc, other, d == kUp ? ends.hi : ends.lo, d);
    log_.touch(arc, ends);
    log_.touch(other, ends_of_other);
  }
  void drop(ArcId arc, const ArcEnds& ends, std::uint32_t nodes) {
    content_.drop(arc, nodes);
    log_.touch(arc, ends);
  }

  // Ends the step, and with it the records of the arcs that were touched.
  void commit() { log_.commit(content_); }
  // Writes the records of the last version, as VersionLog. To be called once, at the end.
  template <class LivingArcOf>
  void finish(std::vector<ArcId> arcs, const LivingArcOf& living_arc_of) {
    log_.finish(content_, std::move(arcs), living_arc_of);
  }

  // A node; where an arc's record and content are stored; the content.
  void prefetch_node(NodeId node) const { content_.prefetch_node(node); }
  void prefetch_value(NodeId node) const { content_.prefetch_value(node); }
  void prefetch_place(ArcId arc) const {
    log_.prefetch(arc);
    content_.prefetch_place(arc);
  }
  void prefetch_content(ArcId arc) const { content_.prefetch(arc); }

 private:
  VersionLog<Graph> log_;
  Content content_;
};

}  // namespace reeb
