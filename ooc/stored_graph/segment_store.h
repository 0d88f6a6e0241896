// Where settled nodes and arcs wait for the second stage: sorted, packed segments on disk
// (DESIGN.md 4, Spilling).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/packed_lists.h"
#include "libreeb/port/graph_sink.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/stored_graph/arc_payload.h"
#include "ooc/stored_graph/graph_change.h"

namespace reeb::ooc {

// An arc with its embedding (arc_payload.h), if it has one.
struct StoredArc {
  ArcKeys keys;
  PayloadPlace payload{};
};

// Columns of a block: value bits as differences (they rise), vertex ids as differences of either
// sign, the rest told from these; byte planes; zstd. Positions are packed apart from keys, which are
// had without them. Then the payloads as they are: means of positions hardly become smaller.
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

// Pull interfaces: read(out, limit) delivers the next in order, rewind() starts again.
using SortedNodes = ExternalSort<SettledNode, NodeCodec, NodeLess>;
using SortedArcs = ExternalSort<StoredArc, ArcCodec, ArcLess>;

// Appends the buckets of an arc, coarsened. THROWS: std::logic_error if they are coarser, or none.
void decode_buckets_of(const ArcKeys& arc, std::span<const std::byte> payload, int bucket_exponent,
                       std::vector<Bucket>& buckets);

// Consecutive arcs with their buckets, all of one exponent.
struct ArcPiece {
  std::vector<ArcKeys> arcs;
  ArcBuckets buckets;  // without offsets where none are wanted
};
// The same with packed lists (packed_buckets.h) as payloads.
using PackedArcPiece = RecordBatch<StoredArc>;

struct SegmentOptions {
  std::uint64_t allowance_bytes = 8 << 20;  // of the budget, half for nodes and half for arcs
  std::uint64_t most_bytes = 0;             // to which it grows where much is stored; 0: not at all
  bool background = true;                   // sort and write segments in threads of their own
  // For segments that another process may have to go on with: FILES.nodes and FILES.arcs. Else the
  // segments are in unnamed files.
  std::string files = {};
};

// Takes nodes and arcs in any order; after finish() it gives them back in canonical order (nodes
// by key, arcs by lo, then hi, parallel ones as they came) as often as needed. While they fit the
// allowance no file is made.
//
// THROWS: Error{kResource} of the budget or the disk; what fails in the background is thrown by
//         the next call.
// MEMORY: the allowance; once finished, up to a quarter of what was free.   THREADS: one at a time.
class SegmentStore : public GraphSink {
 public:
  SegmentStore(const io::TempDir& temp, MemoryBudget& budget, const SegmentOptions& options = {});

  void add_nodes(std::span<const SettledNode> nodes) override { nodes_.add(nodes); }
  void add_arcs(const SettledArcs& settled) override;
  // With lists of this exponent, if there are any.
  void add_arcs(const PackedArcPiece& piece, std::optional<int> bucket_exponent);
  // Ends adding, and merges as far as memory makes it necessary: O(n) for each pass that takes.
  void finish();

  // As of ExternalSort; before finish().
  void save(StateWriter& out);
  void restore(StateReader& in);

  // REQUIRES, for all that follows: finish() was called.
  void rewind_nodes();
  void rewind_arcs();
  // Replaces `nodes` by at most `limit` next ones in order; false at the end.
  bool read_nodes(std::vector<SettledNode>& nodes, std::size_t limit);
  // Replaces `piece` by at most `limit` next arcs in order, fewer if they have many buckets; false at
  // the end. Buckets are delivered if an exponent is given, which is not below any that
  // was added.
  bool read_arcs(ArcPiece& piece, std::size_t limit, std::optional<int> bucket_exponent = {});
  bool read_arcs(PackedArcPiece& piece, std::size_t limit, std::optional<int> bucket_exponent = {});

  // All that was added, in no order but that parallel arcs come as they are read. Blocks without a node or arc
  // for whose keys `wanted` is true, which several threads ask, are hardly unpacked.
  // Calls visit(keys) for all arcs.
  template <class Visit>
  void scan_arc_keys(const Visit& visit) const;
  // Calls visit(arc, batch), with the batch that holds the arc's payload, where wanted(keys) is true.
  template <class Is, class Visit>
  void scan_arcs(const Is& wanted, const Visit& visit) const;
  // Calls visit(node) where wanted(key) is true.
  template <class Is, class Visit>
  void scan_nodes(const Is& wanted, const Visit& visit) const;

  // From now on the graph is read, and counted, with this change; scans go on without it. Rewinds.
  void apply(GraphChange change);

  std::uint64_t node_count() const;
  std::uint64_t arc_count() const;
  // As they were added; coarsening makes fewer of them.
  std::uint64_t bucket_count() const;
  // Of the payloads of all arcs that were added.
  std::uint64_t payload_bytes() const { return payload_bytes_; }
  std::uint64_t spilled_bytes() const { return nodes_.spilled_bytes() + arcs_.spilled_bytes(); }
  // What the budget gets back when the store goes.
  std::uint64_t reserved_bytes() const;
  MemoryBudget& budget() { return *budget_; }
  bool background() const { return background_; }

 private:
  template <class Take>
  bool take_arcs(std::size_t limit, const Take& take);
  void refill_arcs(std::size_t limit);

  MemoryBudget* budget_;
  bool background_;
  SortedNodes nodes_;
  SortedArcs arcs_;
  std::uint64_t bucket_count_ = 0, payload_bytes_ = 0;
  RecordBatch<StoredArc> batch_;  // read last,
  std::size_t next_ = 0;          // delivered so far
  bool at_end_ = false;           // of the stored arcs
  std::optional<ChangeReader> change_;
  std::vector<StoredArc> plain_;
  std::vector<std::byte> payload_;
  CoarsenedList coarsened_;
};

template <class Visit>
void SegmentStore::scan_arc_keys(const Visit& visit) const {
  arcs_.scan_keys([&](const StoredArc& arc) { visit(arc.keys); });
}

template <class Is, class Visit>
void SegmentStore::scan_arcs(const Is& wanted, const Visit& visit) const {
  arcs_.scan([&](const StoredArc& arc) { return wanted(arc.keys); }, visit);
}

template <class Is, class Visit>
void SegmentStore::scan_nodes(const Is& wanted, const Visit& visit) const {
  nodes_.scan([&](const SettledNode& node) { return wanted(node.key); },
              [&](const SettledNode& node, const auto&) { visit(node); });
}

// Adds all of a finished store to another; buckets, if an exponent is given, coarsened to it.
void copy_graph(SegmentStore& from, SegmentStore& to, std::optional<int> bucket_exponent);

// A graph in memory with what it has reserved.
struct LoadedGraph {
  Reservation memory;
  ReebGraph graph;
  PackedLists buckets;  // empty unless wanted
};

struct LoadOptions {
  bool positions = true;
  std::optional<int> bucket_exponent = {};  // buckets are wanted, coarsened to this
};

// What read_graph reserves, at most.
std::uint64_t loading_bytes(const SegmentStore& store, const LoadOptions& options);

// All of a finished store, for a second stage in memory.
//
// THROWS: Error{kResource} if the graph does not fit the budget, before anything is read;
//         std::logic_error if an arc ends in no node.
LoadedGraph read_graph(SegmentStore& store, const LoadOptions& options = {});

}  // namespace reeb::ooc
