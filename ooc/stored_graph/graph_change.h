// A change of a stored graph. It is applied while the graph is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/reeb_graph.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {

// An arc of a change, with its buckets as payload (arc_payload.h).
struct ChangedArc {
  ArcKeys keys;
  SweepKey former_hi;  // the upper end of its lowest part, as stored
  PayloadPlace payload{};
};

// Of parallel arcs, the one whose lowest part was stored first comes first.
struct ChangedArcLess {
  static std::uint64_t rank(const ChangedArc& arc) { return ordered_bits(arc.keys.lo.value); }
  bool operator()(const ChangedArc& a, const ChangedArc& b) const {
    return a.keys < b.keys || (a.keys == b.keys && a.former_hi < b.former_hi);
  }
};

using ChangedArcs = ExternalSort<ChangedArc, PlainCodec<ChangedArc>, ChangedArcLess>;

struct GraphChange {
  Reservation memory;            // of the lists of nodes, and of the table that finds them
  std::vector<SweepKey> redone;  // ascending: nodes whose stored arcs are all replaced
  std::vector<SweepKey> gone;    // ascending: the redone nodes that are removed
  std::uint64_t replaced_arcs = 0, replaced_buckets = 0;
  std::unique_ptr<ChangedArcs> arcs;  // the replacements, with finish() called; a joined arc is placed where its
  std::uint64_t buckets = 0;          // lowest part was among parallel arcs

  std::uint64_t reserved_bytes() const { return memory.bytes() + arcs->reserved_bytes(); }
};

// A position in a change while nodes and arcs are read in their order.
class ChangeReader {
 public:
  explicit ChangeReader(GraphChange change) : change_(std::move(change)), table_(change_.redone) {}
  ChangeReader(const ChangeReader&) = delete;
  ChangeReader& operator=(const ChangeReader&) = delete;

  const GraphChange& change() const { return change_; }
  void rewind_nodes() { gone_ = 0; }
  void rewind_arcs() {
    change_.arcs->rewind();
    arcs_.clear();
    redone_ = arc_ = 0;
  }

  // REQUIRES: since the last rewind, arguments ascend; arcs by lo.
  bool drops(const SweepKey& node) { return is_next(change_.gone, gone_, node); }
  bool drops(const ArcKeys& arc) {
    return is_next(change_.redone, redone_, arc.lo) || table_.find(arc.hi) != NodeTable::kNone;
  }

  // Whether an arc of the change comes before this stored arc; for null, whether one is left. It also comes before a
  // stored arc between the same nodes, because it was joined from parts, the lowest of which ended further down.
  bool comes_before(const ArcKeys* stored) {
    return has_arc() && (stored == nullptr || !(*stored < arcs_.records[arc_].keys));
  }
  // Returns the first remaining arc and advances. It stays until the next call of comes_before().
  // REQUIRES: comes_before() was just true.
  const ChangedArc& take() { return arcs_.records[arc_++]; }
  std::span<const std::byte> payload(const ChangedArc& arc) const { return arcs_.payload(arc); }

 private:
  bool has_arc() {
    constexpr std::size_t kArcsAtOnce = 1024;
    if (arc_ < arcs_.records.size()) return true;
    arc_ = 0;
    return change_.arcs->read(arcs_, kArcsAtOnce);
  }

  // Whether `key` is in the list, starting at index `at`, which advances to it.
  static bool is_next(const std::vector<SweepKey>& list, std::size_t& at, const SweepKey& key) {
    while (at < list.size() && list[at] < key) ++at;
    return at < list.size() && list[at] == key;
  }

  GraphChange change_;
  SparseNodeTable table_;         // of redone nodes
  RecordBatch<ChangedArc> arcs_;  // the arcs read last,
  std::size_t arc_ = 0;           // and how many of them were taken
  std::size_t gone_ = 0, redone_ = 0;
};

}  // namespace reeb::ooc
