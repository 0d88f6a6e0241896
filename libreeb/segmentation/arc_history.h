// Says what arcs became: reads the events of an ArcLog backwards, and finds the settled arc on which a vertex lies.
//
// Going back, each arc has the list of settled arcs that it is in the end, usually one. A merge gives both arcs the
// list of the result, a cut joins two lists, a join divides one. So when the event of a vertex is reached, the list of
// its arc is known. Lists share what they have in common.
//
// TIME: O(log n) for an event, if its arc is n settled arcs. MEMORY: 8 bytes for each number of an arc, 40 for each
// change in a list.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "libreeb/base/sweep_key.h"
#include "libreeb/containers/growing_array.h"
#include "libreeb/port/arc_log.h"

namespace reeb {

struct ArcEvent {
  enum class Kind : std::uint8_t { kAdd, kPlace, kMerge, kCut, kJoin, kLay, kDrop, kSettle };

  Kind kind = Kind::kAdd;
  Direction side = kDown;
  ArcLog::Arc arc = 0;    // the arc that is gone, or that is cut, or the only one
  ArcLog::Arc other = 0;  // the arc that is kept, or gets a part; kSettle: the number of the arc
  SweepKey key{};
};

class ArcHistory {
 public:
  using Arc = ArcLog::Arc;
  // Instead of a settled arc: the arc was dropped.
  static constexpr std::uint32_t kDropped = ~std::uint32_t{0};

  // Goes back over the event. Returns the settled arc on which the vertex event.key lies, for the kinds that place one:
  // kPlace, kJoin and kLay; else kDropped.
  // REQUIRES: called for all events, the last one first.
  std::uint32_t undo(const ArcEvent& event);

  // The settled arc that an arc is at this vertex.
  std::uint32_t find(Arc arc, const SweepKey& vertex) const;
  std::size_t memory_bytes() const { return lists_.memory_bytes() + changes_.memory_bytes(); }

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};

  // The settled arc that an arc is at its lower end, and the places at which that changes, as a treap.
  struct List {
    std::uint32_t first = kDropped;
    Index changes = kNone;
  };
  // From `at` on it is the settled arc `arc`. A change that is part of several lists is never written to.
  struct Change {
    SweepKey at;
    std::uint32_t arc;
    Index left, right;
    std::uint32_t priority;
    std::uint32_t users;
  };

  List& list(Arc arc);
  void release(List& list);
  List copy(const List& list) {
    keep(list.changes);
    return list;
  }
  std::uint32_t last_of(const List& list) const;
  std::pair<List, List> divide(List list, const SweepKey& at);
  List concatenate(List below, List above, const SweepKey& at);

  // Trees. Arguments are used up.
  Index make(SweepKey at, std::uint32_t arc);  // no reference: the array can move
  void keep(Index root) {
    if (root != kNone) ++changes_[root].users;
  }
  void drop(Index root);
  Index own(Index root);
  std::pair<Index, Index> split(Index root, const SweepKey& at);
  Index merge(Index below, Index above);
  Index without_first(Index root);

  GrowingArray<List> lists_;  // by arc
  GrowingArray<Change> changes_;
  Index first_free_ = kNone;
  std::uint64_t made_ = 0;
};

}  // namespace reeb
