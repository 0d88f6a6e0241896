// A change of a stored graph that is made while the graph is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/reeb_graph.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {

// An arc of a change, its buckets as payload (arc_payload.h).
struct ChangedArc {
  ArcKeys keys;
  SweepKey former_hi;  // of its lowest part, as it was stored
  PayloadPlace payload{};
};

struct GraphChange {
  Reservation memory;
  std::vector<SweepKey> redone;  // ascending: nodes of which no stored arc stays
  std::vector<SweepKey> gone;    // ascending: those of them that do not stay either
  std::uint64_t replaced_arcs = 0, replaced_buckets = 0;
  RecordBatch<ChangedArc> arcs;  // that come instead, in order; arcs that were joined have the place of
  std::uint64_t buckets = 0;     // their lowest part among parallel ones
};

// A place in a change, while nodes and arcs go by in their order.
class ChangeReader {
 public:
  explicit ChangeReader(GraphChange change) : change_(std::move(change)), table_(change_.redone) {}
  ChangeReader(const ChangeReader&) = delete;
  ChangeReader& operator=(const ChangeReader&) = delete;

  const GraphChange& change() const { return change_; }
  void rewind_nodes() { gone_ = 0; }
  void rewind_arcs() { redone_ = arc_ = 0; }

  // REQUIRES, since the last rewind: ascending; for arcs, by lo.
  bool drops(const SweepKey& node) { return is_next(change_.gone, gone_, node); }
  bool drops(const ArcKeys& arc) {
    return is_next(change_.redone, redone_, arc.lo) || table_.find(arc.hi) != NodeTable::kNone;
  }

  // Whether an arc of the change comes before this stored one, or, if null, is left. Of a stored arc
  // between the same nodes it does: it was joined, of parts the lowest of which ended below.
  bool comes_before(const ArcKeys* stored) const {
    const auto& arcs = change_.arcs.records;
    return arc_ < arcs.size() && (stored == nullptr || !(*stored < arcs[arc_].keys));
  }
  // The first arc left, and on to the next.
  const ChangedArc& take() { return change_.arcs.records[arc_++]; }
  std::span<const std::byte> payload(const ChangedArc& arc) const { return change_.arcs.payload(arc); }

 private:
  // Whether `key` is in the list, from `at` on, which moves on to it.
  static bool is_next(const std::vector<SweepKey>& list, std::size_t& at, const SweepKey& key) {
    while (at < list.size() && list[at] < key) ++at;
    return at < list.size() && list[at] == key;
  }

  GraphChange change_;
  SparseNodeTable table_;  // of redone nodes
  std::size_t gone_ = 0, redone_ = 0, arc_ = 0;
};

}  // namespace reeb::ooc
