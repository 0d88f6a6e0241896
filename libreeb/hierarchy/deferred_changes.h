// Changes of arcs that are made later, by another thread, while the rules of cancelling run ahead.
//
// WHY. With an embedding, about half of the time of cancelling goes into lists of buckets and into records. The rules
// do not need them, but for one thing: how far a long path next to an arc can be followed at once depends on the
// content of the arc. So a short path is noted arc by arc, and a long one waits for what was noted before.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/hierarchy/arc_changes.h"

namespace reeb {

// How far the rules run ahead. The results do not depend on it. REQUIRES: notes > 0.
struct RunAhead {
  std::size_t notes = 8192;        // in a list, about; a loop with more than a quarter as many arcs waits
  std::size_t arcs_of_path = 256;  // a longer path waits
  // After a pair that waited, so many are cancelled without running ahead, since they would often wait, too.
  std::size_t pairs_in_turn = 64;

  // The lists of a small graph are small.
  static RunAhead for_arcs(std::uint64_t arcs) {
    RunAhead ahead;
    ahead.notes = std::min<std::size_t>(ahead.notes, 64 + arcs / 64);
    return ahead;
  }

  // No list gets longer than this.
  std::size_t most_notes() const { return 2 * notes + arcs_of_path + 32; }
};

// What was done to an arc: a function of ArcChanges and its arguments, or a part of a path.
struct ArcNote {
  static constexpr NodeId kNoNode = NodeId::none();
  enum class Kind : std::uint8_t { kTouch, kCut, kMerge, kJoin, kLay, kDrop, kPath, kPass, kCommit };

  Kind kind = Kind::kCommit;
  Direction direction = kUp;
  ArcId arc = ArcId::none(), other = ArcId::none();
  std::array<NodeId, 3> nodes{kNoNode, kNoNode, kNoNode};
  ArcEnds ends{};
  std::uint32_t count = 0;
};

// While it defers, its functions only note what they were called for.
//
// MEMORY: ArcChanges, and a list of notes.
// THREADS: while it defers, one thread may call apply() and another one note changes.
template <class ContentKind, class Graph>
class DeferredChanges {
 public:
  using Content = ContentKind;
  static constexpr bool kCanDefer = true;

  // REQUIRES: `graph` and `sink` outlive this.
  DeferredChanges(const Graph& graph, RecordSink& sink, Content content) : now_(graph, sink, std::move(content)) {}

  const Content& content() const { return now_.content(); }

  bool defers() const { return defers_; }
  // REQUIRES: all notes were applied.
  void set_defers(bool defers) { defers_ = defers; }
  void set_limits(const RunAhead& limits) {
    limits_ = limits;
    notes_.reserve(limits.most_notes());
  }
  // Whether the rules should stop for now; and whether a path or a loop of this many arcs waits.
  bool is_full() const { return notes_.size() >= limits_.notes; }
  bool is_long_path(std::size_t arcs) const { return arcs > limits_.arcs_of_path; }
  bool is_long_loop(std::size_t arcs) const { return arcs > limits_.notes / 4; }
  // Takes the notes since the last call, in exchange for a list that becomes empty.
  void take_notes(std::vector<ArcNote>& notes) {
    notes.clear();
    std::swap(notes, notes_);
  }
  // Does what these notes say. REQUIRES: all notes before them were applied.
  void apply(const std::vector<ArcNote>& notes);

  // As in ArcChanges.
  void touch(ArcId arc, const ArcEnds& ends) {
    if (!defers_) return now_.touch(arc, ends);
    notes_.push_back({.kind = Kind::kTouch, .arc = arc, .ends = ends});
  }
  void cut(const ArcCut& cut, const ArcEnds& ends_of_into) {
    if (!defers_) return now_.cut(cut, ends_of_into);
    const std::array nodes{cut.start, cut.node, cut.end};
    notes_.push_back({Kind::kCut, cut.direction, cut.from, cut.into, nodes, ends_of_into});
  }
  void merge(ArcId from, ArcId into, const ArcEnds& ends_of_into) {
    if (!defers_) return now_.merge(from, into, ends_of_into);
    notes_.push_back({.kind = Kind::kMerge, .arc = from, .other = into, .ends = ends_of_into});
  }
  void join(ArcId upper, ArcId lower, NodeId node) {
    if (!defers_) return now_.join(upper, lower, node);
    notes_.push_back({.kind = Kind::kJoin, .arc = upper, .other = lower, .nodes = {node, kNoNode, kNoNode}});
  }
  void lay(ArcId arc, ArcId other, NodeId extremum, Direction d, const ArcEnds& ends_of_other) {
    if (!defers_) return now_.lay(arc, other, extremum, d, ends_of_other);
    notes_.push_back({Kind::kLay, d, arc, other, {extremum, kNoNode, kNoNode}, ends_of_other});
  }
  void drop(ArcId arc, std::uint32_t nodes) {
    if (!defers_) return now_.drop(arc, nodes);
    notes_.push_back({.kind = Kind::kDrop, .arc = arc, .count = nodes});
  }
  void commit() {
    if (!defers_) return now_.commit();
    notes_.push_back({.kind = Kind::kCommit});
  }
  // REQUIRES, for these three: it does not defer.
  double first_value(const ArcPart& part) { return now_.first_value(part); }
  bool is_reached(double value, Direction d, NodeId node) const { return now_.is_reached(value, d, node); }
  void finish() { now_.finish(); }

  // Notes a path next to a part of an arc: first the part, and then each arc that is passed. Each of these takes what
  // it can of the content of the part. REQUIRES, as the next two: it defers.
  void begin_path(const ArcPart& part) {
    path_ = notes_.size();
    notes_.push_back(
        {.kind = Kind::kPath, .direction = part.direction, .arc = part.arc, .nodes = {part.start, part.end, kNoNode}});
  }
  void pass(Direction d, ArcId arc, const ArcEnds& ends) {
    const NodeId end = d == kUp ? ends.hi : ends.lo;
    notes_.push_back(
        {.kind = Kind::kPass, .direction = d, .other = arc, .nodes = {end, kNoNode, kNoNode}, .ends = ends});
  }
  // Forgets the path that was begun last.
  void forget_path() { notes_.resize(path_); }

  // For the thread of the rules. While it defers, apply() prefetches what it needs itself.
  void prefetch_node(NodeId node) const {
    if (!defers_) now_.prefetch_node(node);
  }
  void prefetch_place(ArcId arc) const {
    if (!defers_) now_.prefetch_place(arc);
  }
  void prefetch_content(ArcId arc) const {
    if (!defers_) now_.prefetch_content(arc);
  }

 private:
  using Kind = ArcNote::Kind;
  static constexpr NodeId kNoNode = ArcNote::kNoNode;

  void prefetch(const std::vector<ArcNote>& notes, std::size_t at) const;

  ArcChanges<Content, Graph> now_;
  alignas(64) std::vector<ArcNote> notes_;  // not next to what the other thread changes
  std::size_t path_ = 0;                    // the first note of the last path
  RunAhead limits_;
  bool defers_ = false;
};

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::apply(const std::vector<ArcNote>& notes) {
  ArcPart part{};
  double first = 0;
  for (std::size_t i = 0; i < notes.size(); ++i) {
    prefetch(notes, i);
    const ArcNote& note = notes[i];
    const Direction d = note.direction;
    const auto [a, b, c] = note.nodes;
    switch (note.kind) {
      case Kind::kTouch:
        now_.touch(note.arc, note.ends);
        break;
      case Kind::kCut:
        now_.cut({d, note.arc, note.other, a, b, c}, note.ends);
        break;
      case Kind::kMerge:
        now_.merge(note.arc, note.other, note.ends);
        break;
      case Kind::kJoin:
        now_.join(note.arc, note.other, a);
        break;
      case Kind::kLay:
        now_.lay(note.arc, note.other, a, d, note.ends);
        break;
      case Kind::kDrop:
        now_.drop(note.arc, note.count);
        break;
      case Kind::kCommit:
        now_.commit();
        break;
      case Kind::kPath:
        part = {d, note.arc, a, b};
        first = now_.first_value(part);
        break;
      case Kind::kPass:
        if (!now_.is_reached(first, d, a)) break;
        now_.cut({d, part.arc, note.other, part.start, a, part.end}, note.ends);
        part.start = a;
        first = now_.first_value(part);
        break;
    }
  }
}

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::prefetch(const std::vector<ArcNote>& notes, std::size_t at) const {
  constexpr std::size_t kPlace = 40, kContent = 16;  // notes ahead
  if (at + kPlace < notes.size()) {
    const ArcNote& note = notes[at + kPlace];
    for (const ArcId arc : {note.arc, note.other})
      if (arc != ArcId::none()) now_.prefetch_place(arc);
    for (const NodeId node : note.nodes)
      if (node != NodeId::none()) now_.prefetch_node(node);
  }
  if (at + kContent < notes.size()) {
    const ArcNote& note = notes[at + kContent];
    for (const ArcId arc : {note.arc, note.other})
      if (arc != ArcId::none()) now_.prefetch_content(arc);
  }
}

}  // namespace reeb
