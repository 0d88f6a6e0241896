// Changes of arcs that are made later, by another thread, while the rules of cancelling run ahead.
//
// WHY. With an embedding, about half of the time of cancelling goes into lists of buckets and into records. The rules
// do not need them, but for one thing: how far a long path next to an arc can be followed at once depends on the
// content of the arc. So a short path is noted arc by arc. For a long one the rules read the content themselves, once
// what was noted of it is done. They also do so for a short one where they would soon wait for the other thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/hierarchy/arc_changes.h"
#include "libreeb/port/ring_turns.h"

namespace reeb {

// How far the rules run ahead. The results do not depend on it. REQUIRES: notes > 0.
struct RunAhead {
  std::size_t notes = 2048;       // in a list, about
  std::size_t arcs_of_path = 24;  // a path of more arcs is long

  // The lists of a small graph are small.
  static RunAhead for_arcs(std::uint64_t arcs) {
    RunAhead ahead;
    ahead.notes = std::min<std::size_t>(ahead.notes, 16 + arcs / 256);
    return ahead;
  }

  // Room in a list, which holds a short path as a whole. The place of a note is prefetched this many notes before.
  std::size_t most_notes() const { return notes + arcs_of_path + kFetched; }
  static constexpr std::size_t kFetched = 12;
};

// What was done to an arc: a function of ArcChanges and its arguments, or a part of a path.
struct ArcNote {
  static constexpr NodeId kNoNode = NodeId::none();
  enum class Kind : std::uint8_t { kNothing, kTouch, kCutContent, kCut, kMerge, kJoin, kLay, kDrop, kPath, kPass };

  Kind kind = Kind::kNothing;
  bool ends_step = false;
  std::uint8_t count = 0;  // of the nodes that kDrop drops
  Direction direction : 8 = kUp;
  ArcId arc = ArcId::none(), other = ArcId::none();
  std::array<NodeId, 3> nodes{kNoNode, kNoNode, kNoNode};
  ArcEnds ends{};
};
static_assert(sizeof(ArcNote) == 32);  // half a cache line: two threads share the lists

// Its functions only note what they were called for; apply() does it. Between the two is a ring of lists of notes.
//
// MEMORY: ArcChanges, with what is held; the lists, and 8 bytes per note of a step; 2 bytes per arc.
// THREADS: one calls apply() while another one calls everything else; finish() comes after both.
template <class ContentKind, class Graph>
class DeferredChanges {
 public:
  using Content = ContentKind;
  static constexpr bool kDefers = true;
  // The thread that applies the notes has failed, so there is no use in noting more.
  struct Stopped {};

  // REQUIRES: `graph` and `sink` outlive this.
  DeferredChanges(const Graph& graph, RecordSink& sink, Content content) : now_(graph, sink, std::move(content)) {}

  const Content& content() const { return now_.content(); }
  // To be called once, before all that follows. REQUIRES: `turns` outlives this.
  void start(RingTurns& turns, const RunAhead& limits, std::size_t arcs) {
    turns_ = &turns;
    limits_ = limits;
    for (List& list : lists_) list.notes.reserve(limits.most_notes());
    noted_in_.assign(arcs, 0);
  }

  // Does what the notes say, until no more are noted. Calls poll() with the part of the work that is done. THROWS: what
  // poll and the sink throw.
  void apply(const Poll& poll);
  // REQUIRES: apply() has returned.
  template <class LivingArcOf>
  void finish(std::vector<ArcId> arcs, const LivingArcOf& living_arc_of) {
    now_.finish(std::move(arcs), living_arc_of);
  }

  // For the thread of the rules: the part of the work that was noted; and that nothing more is noted.
  void set_done(double done) { done_ = done; }
  void close() noexcept;

  // As in ArcChanges. THROWS, all that note something: Stopped.
  void touch(ArcId arc, const ArcEnds& ends) { note({.kind = Kind::kTouch, .arc = arc, .ends = ends}); }
  void cut_content(const ArcCut& cut, const ArcEnds& ends_of_into) { note_cut(Kind::kCutContent, cut, ends_of_into); }
  void cut(const ArcCut& cut, const ArcEnds& ends_of_into) { note_cut(Kind::kCut, cut, ends_of_into); }
  void merge(ArcId from, ArcId into, const ArcEnds& ends_of_both) {
    note_content(from);
    note_content(into);
    note({.kind = Kind::kMerge, .arc = from, .other = into, .ends = ends_of_both});
  }
  void join(const ArcJoin& join) {
    note_content(join.upper);
    note_content(join.lower);
    note({.kind = Kind::kJoin, .arc = join.upper, .other = join.lower, .nodes = {join.node, join.lo, join.hi}});
  }
  void lay(ArcId arc, const ArcEnds& ends, ArcId other, const ArcEnds& ends_of_other, Direction d) {
    note_content(arc);
    note_content(other);
    note({.kind = Kind::kLay,
          .direction = d,
          .arc = arc,
          .other = other,
          .nodes = d == kUp ? std::array{ends.hi, ends.lo, kNoNode} : std::array{ends.lo, ends.hi, kNoNode},
          .ends = ends_of_other});
  }
  void drop(ArcId arc, const ArcEnds& ends, std::uint32_t nodes) {
    note_content(arc);
    note({.kind = Kind::kDrop, .count = static_cast<std::uint8_t>(nodes), .arc = arc, .ends = ends});
  }
  void commit() {
    for (const ArcId arc : changed_) noted_in_[arc.value()] = list_;
    changed_.clear();
    if (notes().empty())
      note({.ends_step = true});
    else
      notes().back().ends_step = true;
  }
  bool is_reached(double value, Direction d, NodeId node) const { return now_.is_reached(value, d, node); }

  // Notes a path next to a part of an arc: first the part, and then each arc that is passed. Each of these takes what
  // it can of the content of the part. In the end, forget_path() is called, or end_path() if an arc was passed.
  void begin_path(const ArcPart& part) {
    path_ = notes().size();
    notes().push_back(
        {.kind = Kind::kPath, .direction = part.direction, .arc = part.arc, .nodes = {part.start, part.end, kNoNode}});
  }
  bool is_long_path(std::size_t arcs) const { return arcs > limits_.arcs_of_path; }
  void pass(Direction d, ArcId arc, const ArcEnds& ends) {
    const NodeId end = d == kUp ? ends.hi : ends.lo;
    notes().push_back(
        {.kind = Kind::kPass, .direction = d, .other = arc, .nodes = {end, kNoNode, kNoNode}, .ends = ends});
  }
  void end_path() {
    note_content(notes()[path_].arc);
    for (std::size_t i = path_ + 1; i < notes().size(); ++i) note_content(notes()[i].other);
    pass_on_if_full();
  }
  void forget_path() { notes().resize(path_); }

  // Reads the content of the arc, for first_value(): then the cuts of a long path are noted one by one.
  // REQUIRES: this step did not change it.
  void begin_long_path(const ArcPart& part);
  // The same for a path of any length, if the other thread is far behind, and no note of the arc waits for it; else it
  // returns false. That thread is then spared the notes of arcs to which nothing is moved, which are most of them.
  bool begin_known_path(const ArcPart& part);
  double first_value(const ArcPart& part) { return now_.content().first_value(part, rest_); }

  // For the thread of the rules; apply() prefetches what it needs itself.
  void prefetch_node(NodeId /*node*/) const {}
  void prefetch_place(ArcId arc) const { reeb::prefetch(&noted_in_[arc.value()]); }
  void prefetch_content(ArcId /*arc*/) const {}

 private:
  using Kind = ArcNote::Kind;
  static constexpr NodeId kNoNode = ArcNote::kNoNode;
  static_assert((1u << 16) % RingTurns::kSlots == 0);  // numbers of lists go on after 2^16

  struct List {
    alignas(64) std::vector<ArcNote> notes;  // two threads change neighbouring lists
    double done = 0;                         // the part of the work that is done when these notes are
  };
  // While this exists, the other thread neither reads content for a long path nor moves any.
  class Alone {
   public:
    explicit Alone(RingTurns& turns) : turns_(turns) { turns_.lock(); }
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;
    ~Alone() { turns_.unlock(); }

   private:
    RingTurns& turns_;
  };

  std::vector<ArcNote>& notes() { return lists_[list_ % lists_.size()].notes; }
  void note(const ArcNote& note) {
    // The other thread has read this list before.
    reeb::prefetch_to_write(notes().data() + notes().size() + RunAhead::kFetched);
    notes().push_back(note);
    pass_on_if_full();
  }
  void pass_on_if_full() {
    if (notes().size() >= limits_.notes) pass_on();
  }
  void pass_on() {
    if (!is_passed_on()) throw Stopped();
  }
  bool is_passed_on() {
    lists_[list_++ % lists_.size()].done = done_;
    return turns_->filled();
  }
  void note_content(ArcId arc) { changed_.push_back(arc); }
  // The number of lists from the last one that changes the content of the arc to the open one, modulo 2^16: too small a
  // number only means waiting in vain.
  std::uint16_t lists_since(ArcId arc) const { return static_cast<std::uint16_t>(list_ - noted_in_[arc.value()]); }
  void start_rest(const ArcPart& part) {
    const Alone alone(*turns_);
    now_.content().start_rest(part, rest_);
  }
  void note_cut(Kind kind, const ArcCut& cut, const ArcEnds& ends_of_into) {
    note_content(cut.from);
    note_content(cut.into);
    note({.kind = kind,
          .direction = cut.direction,
          .arc = cut.from,
          .other = cut.into,
          .nodes = {cut.start, cut.node, cut.end},
          .ends = ends_of_into});
  }
  std::size_t apply(const std::vector<ArcNote>& notes, std::size_t next);
  void prefetch(const std::vector<ArcNote>& notes, std::size_t at) const;

  ArcChanges<Content, Graph> now_;
  ArcPart part_{};  // of the path that is applied
  double first_ = 0;
  std::array<List, RingTurns::kSlots> lists_;
  RingTurns* turns_ = nullptr;

  // What only the thread of the rules uses.
  alignas(64) std::size_t path_ = 0;     // the first note of the last path
  std::vector<ArcId> changed_;           // by this step; some more than once
  std::vector<std::uint16_t> noted_in_;  // by arc: the list with the end of the last step that changed its content
  std::uint16_t list_ = 2 * RingTurns::kSlots;  // the number of the open list, modulo 2^16
  typename Content::Rest rest_;                 // of a long path
  double done_ = 0;
  RunAhead limits_;
};

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::close() noexcept {
  is_passed_on();
  turns_->close();
}

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::begin_long_path(const ArcPart& part) {
  std::uint16_t lists = lists_since(part.arc);
  if (lists == 0) {
    pass_on();
    lists = 1;
  }
  if (!turns_->wait_until_used(lists - 1)) throw Stopped();
  start_rest(part);
}

template <class Content, class Graph>
bool DeferredChanges<Content, Graph>::begin_known_path(const ArcPart& part) {
  const std::size_t full = turns_->full();
  if (full < RingTurns::kSlots - 1 || lists_since(part.arc) <= full) return false;
  start_rest(part);
  return true;
}

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::apply(const Poll& poll) {
  struct StopAtEnd {
    RingTurns& turns;
    ~StopAtEnd() { turns.stop(); }
  } const stop{*turns_};
  for (std::size_t at = 0; turns_->next(); at = (at + 1) % lists_.size()) {
    auto& [notes, done] = lists_[at];
    if (poll) poll(done);
    for (std::size_t next = 0; next < notes.size();) {
      {
        const Alone alone(*turns_);
        now_.content().hold(notes.size() - next);
      }
      next = apply(notes, next);
      const Alone alone(*turns_);
      now_.content().release();
    }
    notes.clear();
    turns_->used();
  }
}

// Applies the notes from `next` on, and returns where it stopped: early if the content holds much.
template <class Content, class Graph>
std::size_t DeferredChanges<Content, Graph>::apply(const std::vector<ArcNote>& notes, std::size_t next) {
  while (next < notes.size()) {
    prefetch(notes, next);
    const ArcNote& note = notes[next++];
    const Direction d = note.direction;
    const auto [a, b, c] = note.nodes;
    switch (note.kind) {
      case Kind::kNothing:
        break;
      case Kind::kTouch:
        now_.touch(note.arc, note.ends);
        break;
      case Kind::kCutContent:
        now_.cut_content({d, note.arc, note.other, a, b, c}, note.ends);
        break;
      case Kind::kCut:
        now_.cut({d, note.arc, note.other, a, b, c}, note.ends);
        break;
      case Kind::kMerge:
        now_.merge(note.arc, note.other, note.ends);
        break;
      case Kind::kJoin:
        now_.join({note.arc, note.other, b, a, c});
        break;
      case Kind::kLay:
        now_.lay(note.arc, ends_along(d, b, a), note.other, note.ends, d);
        break;
      case Kind::kDrop:
        now_.drop(note.arc, note.ends, note.count);
        break;
      case Kind::kPath:
        part_ = {d, note.arc, a, b};
        first_ = now_.first_value(part_);
        break;
      case Kind::kPass:
        if (!now_.is_reached(first_, d, a)) break;
        now_.cut_content({d, part_.arc, note.other, part_.start, a, part_.end}, note.ends);
        part_.start = a;
        first_ = now_.first_value(part_);
        break;
    }
    if (!note.ends_step) continue;
    now_.commit();
    if (now_.content().holds_much()) return next;
  }
  return next;
}

template <class Content, class Graph>
void DeferredChanges<Content, Graph>::prefetch(const std::vector<ArcNote>& notes, std::size_t at) const {
  constexpr std::size_t kPlace = 40, kContent = 16;  // notes ahead
  if (at + kPlace < notes.size()) {
    const ArcNote& note = notes[at + kPlace];
    for (const ArcId arc : {note.arc, note.other})
      if (arc != ArcId::none()) now_.prefetch_place(arc);
    if (note.kind == Kind::kJoin || note.kind == Kind::kLay) {
      now_.prefetch_node(note.nodes[0]);  // the node that enters a bucket; the others are only recorded
    } else {
      for (const NodeId node : note.nodes)
        if (node != NodeId::none()) now_.prefetch_value(node);
    }
  }
  if (at + kContent < notes.size()) {
    const ArcNote& note = notes[at + kContent];
    for (const ArcId arc : {note.arc, note.other})
      if (arc != ArcId::none()) now_.prefetch_content(arc);
  }
}

}  // namespace reeb
