// The store of settled nodes and arcs until the second stage: sorted, packed segments on disk.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/stored_graph/arc_payload.h"
#include "ooc/stored_graph/graph_change.h"

namespace reeb::ooc {

// An arc with its buckets (arc_payload.h), if it has any.
struct StoredArc {
  ArcKeys keys;
  PayloadPlace payload{};
};

// Columns of a block: the bits of values as differences (they rise), vertex ids as differences of either sign, upper
// ends relative to lower ones; then byte planes; then zstd. Positions are packed apart from keys, so that keys can be
// read without them, and as they are: one says little of the next, and the lowest planes of a float are zeros. The
// payloads follow uncompressed: means of positions hardly become smaller.
struct NodeCodec {
  static void encode(std::span<const SettledNode> nodes, std::vector<std::byte>& packed);
  static bool decode_keys(std::span<const std::byte> packed, std::span<SettledNode> nodes);
  static bool decode(std::span<const std::byte> packed, std::span<SettledNode> nodes);
};
struct ArcCodec {
  static void encode(std::span<const StoredArc> arcs, std::span<const std::byte> pool, std::vector<std::byte>& packed);
  static bool decode_keys(std::span<const std::byte> packed, std::span<StoredArc> arcs);
  static bool decode(std::span<const std::byte> packed, std::span<StoredArc> arcs, std::vector<std::byte>& pool);
};
struct NodeLess {
  static std::uint64_t rank(const SettledNode& node) { return ordered_bits(node.key.value); }
  bool operator()(const SettledNode& a, const SettledNode& b) const { return a.key < b.key; }
};
struct ArcLess {
  static std::uint64_t rank(const StoredArc& arc) { return ordered_bits(arc.keys.lo.value); }
  bool operator()(const StoredArc& a, const StoredArc& b) const { return a.keys < b.keys; }
};

// Pull interfaces: read(out, limit) delivers the next records in order, rewind() starts over.
using SortedNodes = ExternalSort<SettledNode, NodeCodec, NodeLess>;
using SortedArcs = ExternalSort<StoredArc, ArcCodec, ArcLess>;

// Appends the buckets of an arc, coarsened. THROWS: BrokenGraph if they are coarser, or not a payload.
void decode_buckets_of(const ArcKeys& arc, std::span<const std::byte> payload, int bucket_exponent,
                       std::vector<Bucket>& buckets);

// Consecutive arcs with their buckets, all of one exponent.
struct ArcPiece {
  std::vector<ArcKeys> arcs;
  ArcLists lists;  // none if no buckets are wanted
};

struct SegmentOptions {
  std::uint64_t allowance_bytes = 8 << 20;  // of the budget; half for nodes, half for arcs
  std::uint64_t most_bytes = 0;             // limit to which it grows if much is stored; 0: it does not grow
  bool background = true;                   // sort and write segments in separate threads
  // For segments from which another process can resume: FILES.nodes and FILES.arcs. Empty: unnamed files.
  std::string files = {};
  // Called often while the store is merged or scanned, in the thread that asks for it. It may throw to stop.
  std::function<void()> poll = {};
};

// Takes nodes and arcs in any order. After finish() it returns them in canonical order as often as needed: nodes by
// key, arcs by lo, then hi; parallel arcs keep their order of adding. No file is made while they fit the allowance.
//
// THROWS: Error{kResource} of the budget or the disk. An error in the background is thrown by the next call.
// MEMORY: the allowance; after finish(), up to a quarter of what was free.   THREADS: one at a time.
class SegmentStore : public GraphSink {
 public:
  SegmentStore(const io::TempDir& temp, MemoryBudget& budget, const SegmentOptions& options = {});

  void add_nodes(std::span<const SettledNode> nodes) override { nodes_.add(nodes); }
  void add_arcs(const SettledArcs& settled) override;
  // Ends adding, and merges as far as memory requires: O(n) per merging pass.
  void finish();

  // As in ExternalSort. REQUIRES: finish() was not called.
  void save(StateWriter& out);
  void restore(StateReader& in);
  // More than the id of any vertex that restore() found in memory.
  std::uint64_t restored_vertex_bound() const { return restored_vertex_bound_; }

  // REQUIRES, for everything below: finish() was called.
  void rewind_nodes();
  void rewind_arcs();
  // Gives the memory for merging back; rewind_nodes() and rewind_arcs() reserve it again. REQUIRES: nodes and arcs are
  // rewound before they are read.
  void set_aside();
  // Replaces `nodes` by the next nodes in order, at most `limit`. False at the end.
  // THROWS: BrokenGraph if a node was added twice.
  bool read_nodes(std::vector<SettledNode>& nodes, std::size_t limit);
  // Replaces `piece` by the next arcs in order: at most `limit`, fewer if they have many buckets. False at the end.
  // Buckets are delivered if an exponent is given. REQUIRES: it is not below any exponent that was added.
  bool read_arcs(ArcPiece& piece, std::size_t limit, std::optional<int> bucket_exponent = {});

  // The scans visit everything added, in unspecified order; parallel arcs keep their reading order. `wanted` is called
  // concurrently. A block with no wanted key is decoded only as far as its keys.
  // Calls visit(keys) for all arcs.
  template <class Visit>
  void scan_arc_keys(const Visit& visit) const;
  // Calls visit(arc, batch) for arcs for which wanted(keys) is true. `batch` holds the arc's payload.
  template <class Predicate, class Visit>
  void scan_arcs(const Predicate& wanted, const Visit& visit) const;
  // Calls visit(node) for nodes for which wanted(key) is true.
  template <class Predicate, class Visit>
  void scan_nodes(const Predicate& wanted, const Visit& visit) const;

  // From now on the graph is read and counted with this change. Scans continue without it. Rewinds.
  void apply(GraphChange change);

  std::uint64_t node_count() const;
  std::uint64_t arc_count() const;
  // The number of buckets as added; coarsening reduces it.
  std::uint64_t bucket_count() const;
  // The bytes of the payloads of all arcs that were added.
  std::uint64_t payload_bytes() const { return payload_bytes_; }
  std::uint64_t spilled_bytes() const { return nodes_.spilled_bytes() + arcs_.spilled_bytes(); }
  // What the budget gets back when the store is destroyed.
  std::uint64_t reserved_bytes() const;
  MemoryBudget& budget() { return *budget_; }
  bool background() const { return background_; }

 private:
  template <class Take>
  bool take_arcs(std::size_t limit, const Take& take);
  void refill_arcs(std::size_t limit);

  MemoryBudget* budget_;
  bool background_;
  std::function<void()> poll_;
  SortedNodes nodes_;
  std::optional<SweepKey> last_node_;  // that was read
  SortedArcs arcs_;
  std::uint64_t bucket_count_ = 0, payload_bytes_ = 0;
  std::uint64_t restored_vertex_bound_ = 0;
  RecordBatch<StoredArc> batch_;  // the batch read last,
  std::size_t next_ = 0;          // and how many of its records were delivered
  bool at_end_ = false;           // of the stored arcs
  std::optional<ChangeReader> change_;
  std::vector<StoredArc> plain_;  // of add_arcs()
  std::vector<std::byte> payload_;
  CoarsenedList coarsened_;
};

template <class Visit>
void SegmentStore::scan_arc_keys(const Visit& visit) const {
  arcs_.scan_keys([&](const StoredArc& arc) { visit(arc.keys); });
}

template <class Predicate, class Visit>
void SegmentStore::scan_arcs(const Predicate& wanted, const Visit& visit) const {
  arcs_.scan([&](const StoredArc& arc) { return wanted(arc.keys); }, visit);
}

template <class Predicate, class Visit>
void SegmentStore::scan_nodes(const Predicate& wanted, const Visit& visit) const {
  nodes_.scan([&](const SettledNode& node) { return wanted(node.key); },
              [&](const SettledNode& node, const auto&) { visit(node); });
}

// Copies a finished store to another. If an exponent is given, buckets are copied, coarsened to it. Calls `poll` often;
// it may throw to stop.
void copy_graph(SegmentStore& from, SegmentStore& to, std::optional<int> bucket_exponent,
                const std::function<void()>& poll);

}  // namespace reeb::ooc
