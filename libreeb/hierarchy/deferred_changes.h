// Changes of arcs that are made later, by another thread, while the rules of cancelling run ahead.
//
// WHY. With an embedding, about half of the time of cancelling goes into lists of buckets and into records. The rules
// do not need them, but for one thing: how far a long path next to an arc can be followed at once depends on the
// content of the arc. So a short path is noted arc by arc. For a long one the rules read the content themselves. They
// wait if a change of it was noted that might not be made yet.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/hierarchy/arc_changes.h"

namespace reeb {

// How far the rules run ahead. The results do not depend on it. REQUIRES: notes > 0.
struct RunAhead {
  std::size_t notes = 4096;       // in a list, about
  std::size_t arcs_of_path = 24;  // a path of more arcs is long

  // The lists of a small graph are small.
  static RunAhead for_arcs(std::uint64_t arcs) {
    RunAhead ahead;
    ahead.notes = std::min<std::size_t>(ahead.notes, 16 + arcs / 256);
    return ahead;
  }

  // No list gets longer than this. A path or loop that needs more waits, and then is not deferred.
  std::size_t most_notes() const { return 8 * notes + arcs_of_path + 2 * kNotesBetween; }
  // Between two paths or loops there are fewer notes than this.
  static constexpr std::size_t kNotesBetween = 32;
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
// MEMORY: ArcChanges, with what is held; two lists of notes, and 8 bytes per note of a step; 2 bytes per arc.
// THREADS: while it defers, and between hold() and release(), one thread may call apply() and another one note changes
//          and read the content of an arc for a long path.
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
  void set_limits(const RunAhead& limits, std::size_t arcs) {
    limits_ = limits;
    notes_.reserve(limits.most_notes());
    applied_.reserve(limits.most_notes());
    noted_in_.assign(arcs, 0);
  }
  // Whether the next pair should wait.
  bool is_full() const { return notes_.size() >= limits_.notes; }
  bool has_notes() const { return !notes_.empty(); }

  // Takes the notes since the last call as those that are to be applied. REQUIRES: those before were applied.
  void hand_over() {
    applied_.clear();
    next_ = 0;
    std::swap(applied_, notes_);
    ++list_;
  }
  // Does what the notes say that were handed over. While it is held, it stops early if much is held.
  void apply();
  void hold() { now_.content().hold(applied_.size() - next_); }
  void release() { now_.content().release(); }

  // As in ArcChanges.
  void touch(ArcId arc, const ArcEnds& ends) {
    if (!defers_) return now_.touch(arc, ends);
    notes_.push_back({.kind = Kind::kTouch, .arc = arc, .ends = ends});
  }
  void cut(const ArcCut& cut, const ArcEnds& ends_of_into) {
    if (!defers_) return now_.cut(cut, ends_of_into);
    note_content(cut.from);
    note_content(cut.into);
    const std::array nodes{cut.start, cut.node, cut.end};
    notes_.push_back({Kind::kCut, cut.direction, cut.from, cut.into, nodes, ends_of_into});
  }
  void merge(ArcId from, ArcId into, const ArcEnds& ends_of_into) {
    if (!defers_) return now_.merge(from, into, ends_of_into);
    note_content(from);
    note_content(into);
    notes_.push_back({.kind = Kind::kMerge, .arc = from, .other = into, .ends = ends_of_into});
  }
  void join(ArcId upper, ArcId lower, NodeId node) {
    if (!defers_) return now_.join(upper, lower, node);
    note_content(upper);
    note_content(lower);
    notes_.push_back({.kind = Kind::kJoin, .arc = upper, .other = lower, .nodes = {node, kNoNode, kNoNode}});
  }
  void lay(ArcId arc, ArcId other, NodeId extremum, Direction d, const ArcEnds& ends_of_other) {
    if (!defers_) return now_.lay(arc, other, extremum, d, ends_of_other);
    note_content(arc);
    note_content(other);
    notes_.push_back({Kind::kLay, d, arc, other, {extremum, kNoNode, kNoNode}, ends_of_other});
  }
  void drop(ArcId arc, std::uint32_t nodes) {
    if (!defers_) return now_.drop(arc, nodes);
    note_content(arc);
    notes_.push_back({.kind = Kind::kDrop, .arc = arc, .count = nodes});
  }
  void commit() {
    for (const ArcId arc : changed_) noted_in_[arc.value()] = list_;
    changed_.clear();
    if (!defers_) return now_.commit();
    notes_.push_back({.kind = Kind::kCommit});
  }
  // REQUIRES: if it defers, begin_long_path() for this arc.
  double first_value(const ArcPart& part) {
    return defers_ ? now_.content().first_value(part, rest_) : now_.first_value(part);
  }
  bool is_reached(double value, Direction d, NodeId node) const { return now_.is_reached(value, d, node); }
  // REQUIRES: it does not defer.
  void finish() { now_.finish(); }

  // REQUIRES, for all that follows: it defers.

  // Whether a path can be noted, or a long one continued; and whether a loop of this many arcs can be noted.
  bool has_room() const { return has_room_for(limits_.arcs_of_path); }
  bool has_room_for_loop(std::size_t arcs) const { return has_room_for(kNotesPerArc * arcs); }

  // Notes a path next to a part of an arc: first the part, and then each arc that is passed. Each of these takes what
  // it can of the content of the part.
  void begin_path(const ArcPart& part) {
    start_path();
    notes_.push_back(
        {.kind = Kind::kPath, .direction = part.direction, .arc = part.arc, .nodes = {part.start, part.end, kNoNode}});
  }
  bool is_long_path(std::size_t arcs) const { return arcs > limits_.arcs_of_path; }
  void pass(Direction d, ArcId arc, const ArcEnds& ends) {
    const NodeId end = d == kUp ? ends.hi : ends.lo;
    notes_.push_back(
        {.kind = Kind::kPass, .direction = d, .other = arc, .nodes = {end, kNoNode, kNoNode}, .ends = ends});
  }
  // To be called unless it is forgotten.
  void end_path() {
    if (notes_.size() == path_ + 1) return forget_path();
    note_content(notes_[path_].arc);
    for (std::size_t i = path_ + 1; i < notes_.size(); ++i) note_content(notes_[i].other);
  }

  // Reads the content of the arc, for first_value(): then the cuts of a long path are noted one by one. False if the
  // content depends on what might not be applied yet. REQUIRES: this step did not change it.
  bool begin_long_path(const ArcPart& part) {
    start_path();
    if (static_cast<std::uint16_t>(list_ - noted_in_[part.arc.value()]) < 2) return false;
    now_.content().start_rest(part, rest_);
    return true;
  }

  // Forgets the path that was begun last.
  void forget_path() {
    notes_.resize(path_);
    changed_.resize(changed_before_path_);
  }

  // For the thread of the rules. While it defers, apply() prefetches what it needs itself.
  void prefetch_node(NodeId node) const {
    if (!defers_) now_.prefetch_node(node);
  }
  void prefetch_place(ArcId arc) const {
    if (defers_) return reeb::prefetch(&noted_in_[arc.value()]);
    now_.prefetch_place(arc);
  }
  void prefetch_content(ArcId arc) const {
    if (!defers_) now_.prefetch_content(arc);
  }

 private:
  using Kind = ArcNote::Kind;
  static constexpr NodeId kNoNode = ArcNote::kNoNode;

  static constexpr std::size_t kNotesPerArc = 2;  // of a loop

  bool has_room_for(std::size_t notes) const {
    return notes_.size() + notes + RunAhead::kNotesBetween <= limits_.most_notes();
  }
  void start_path() {
    path_ = notes_.size();
    changed_before_path_ = changed_.size();
  }
  void note_content(ArcId arc) { changed_.push_back(arc); }
  void prefetch(std::size_t at) const;

  ArcChanges<Content, Graph> now_;
  std::vector<ArcNote> applied_;  // handed over
  std::size_t next_ = 0;          // in applied_
  ArcPart part_{};                // of the path that is applied
  double first_ = 0;
  alignas(64) std::vector<ArcNote> notes_;          // not next to what the other thread changes
  std::size_t path_ = 0, changed_before_path_ = 0;  // the first note of the last path; changed_ before it
  // Lists of notes are numbered, modulo 2^16. What the last two say might not be applied yet. The content of an arc is
  // replaced when the step ends that changes it, whose notes may be in several lists.
  std::vector<ArcId> changed_;           // by this step; some more than once
  std::vector<std::uint16_t> noted_in_;  // by arc: the list with the end of the last step that changed its content
  std::uint16_t list_ = 2;
  typename Content::Rest rest_;  // of a long path
  RunAhead limits_;
  bool defers_ = false;
};

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::apply() {
  while (next_ < applied_.size()) {
    prefetch(next_);
    const ArcNote& note = applied_[next_++];
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
        if (now_.content().holds_much()) return;
        break;
      case Kind::kPath:
        part_ = {d, note.arc, a, b};
        first_ = now_.first_value(part_);
        break;
      case Kind::kPass:
        if (!now_.is_reached(first_, d, a)) break;
        now_.cut({d, part_.arc, note.other, part_.start, a, part_.end}, note.ends);
        part_.start = a;
        first_ = now_.first_value(part_);
        break;
    }
  }
}

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::prefetch(std::size_t at) const {
  constexpr std::size_t kPlace = 40, kContent = 16;  // notes ahead
  if (at + kPlace < applied_.size()) {
    const ArcNote& note = applied_[at + kPlace];
    for (const ArcId arc : {note.arc, note.other})
      if (arc != ArcId::none()) now_.prefetch_place(arc);
    const bool reads_position = note.kind == Kind::kJoin || note.kind == Kind::kLay;
    for (const NodeId node : note.nodes) {
      if (node == NodeId::none()) continue;
      if (reads_position)
        now_.prefetch_node(node);
      else
        now_.prefetch_value(node);
    }
  }
  if (at + kContent < applied_.size()) {
    const ArcNote& note = applied_[at + kContent];
    for (const ArcId arc : {note.arc, note.other})
      if (arc != ArcId::none()) now_.prefetch_content(arc);
  }
}

}  // namespace reeb
