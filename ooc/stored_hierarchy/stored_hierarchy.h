// Pairing and cancelling a graph that memory does not hold (docs/ARCHITECTURE.md, The second stage beyond memory).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/pair_sweeps.h"
#include "libreeb/hierarchy/working_graph.h"
#include "libreeb/port/record_sink.h"
#include "ooc/reeb_writer/hierarchy_source.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/sorting/record_cursor.h"
#include "ooc/stored_graph/segment_store.h"
#include "ooc/stored_hierarchy/introduced_nodes.h"
#include "ooc/stored_hierarchy/paged_tables.h"
#include "ooc/stored_hierarchy/stored_lists.h"
#include "ooc/stored_hierarchy/stored_nodes.h"

namespace reeb::ooc {

struct CancelledBefore {
  bool operator()(const RankedPair& a, const RankedPair& b) const { return is_cancelled_before(a, b); }
};
using SortedPairs = ExternalSort<RankedPair, PlainCodec<RankedPair>, CancelledBefore>;

// The same steps in the same order as build_hierarchy(), on the same numbers of nodes and arcs, so pairs and records
// are the same. But the tables of the canceller and the nodes are in pages, pairs are sorted on disk, and lists of
// buckets are read where they are needed. Noise is local: the nodes of a pair of small persistence are near each
// other in the total order, and so are their arcs. So a step finds nearly all it needs in few pages. Where that is not
// so, as with a random function, a step would wait for dozens of pages; then it gives up.
//
// THROWS: Error{kResource} of the disk.   THREADS: one at a time.
class StoredHierarchy : public HierarchySource {
 public:
  struct Options {
    std::optional<int> bucket_exponent = {};  // without one there is no embedding
    bool background = true;                   // sort in separate threads
    std::uint64_t most_pages = 32;            // that a pair may read again, on average; scans take about one
  };

  // The memory that it needs at least. With several times as much, it is faster.
  static std::uint64_t least_bytes(std::uint64_t nodes);

  // REQUIRES: all of them outlive this; free_bytes() of the budget is at least least_bytes(). `store` is finished.
  StoredHierarchy(SegmentStore& store, const io::TempDir& temp, MemoryBudget& budget, const Options& options);

  // Reads the graph and pairs its nodes. The store is not needed afterwards, and is set aside.
  void pair_nodes(const Poll& poll);
  // Cancels all pairs but Ext0. False if it gave up because pages of the tables are asked for at random; then there is
  // no hierarchy to write. REQUIRES: pair_nodes() was called.
  bool cancel(RecordSink& records, const Poll& poll);

  // The most memory that it reserves while the file is written.
  std::uint64_t writing_bytes() const { return 2 * shares_.sort; }
  // The memory of the tables, which cancel() gives back.
  std::uint64_t table_bytes() const { return tables_ ? tables_->resident_bytes() : 0; }
  std::uint64_t pair_count() const { return pairs_.size(); }
  // How often cancel() read a page of a table again.
  std::uint64_t refetches() const { return refetches_; }
  std::uint64_t spilled_bytes() const;

  std::size_t node_count() const override { return nodes_; }
  SweepKey key(NodeId id) override { return node_data_.key(id); }
  bool has_positions() const override { return nodes_ != 0; }
  void introduce(NodeId id, std::uint32_t frame) override { introduced_->add(id, frame); }
  SettledNode node(NodeId id) override { return introduced_->next(id, node_data_); }
  void rewind_pairs() override;
  bool next_pair(PersistencePair& pair) override;
  std::span<const double> persistence() const override { return persistence_; }
  std::span<const NodeId> isolated() const override { return isolated_; }

 private:
  // Where the memory goes.
  struct Shares {
    std::uint64_t sort = 0, nodes = 0, tables = 0;
  };
  static Shares share_out(std::uint64_t free, std::uint64_t nodes, bool embeds);

  // An arc on its way to the order of upper ends.
  struct ArcToSort {
    SweepKey hi;
    std::uint32_t lo = 0, arc = 0;
    friend bool operator<(const ArcToSort& a, const ArcToSort& b) {
      return a.hi < b.hi || (a.hi == b.hi && a.arc < b.arc);
    }
  };
  using SortedByUpperEnd = ExternalSort<ArcToSort>;

  StoredHierarchy(SegmentStore& store, const io::TempDir& temp, MemoryBudget& budget, const Options& options,
                  const Shares& shares);
  SortOptions sort_options() const { return {.allowance_bytes = shares_.sort, .background = options_.background}; }
  void read_nodes();
  void sort_arcs(SortedByUpperEnd& arcs, const Poll& poll);
  void pair_arcs(SortedByUpperEnd& arcs, const Poll& poll);
  void add_pair(const PersistencePair& pair);
  template <class Canceller>
  bool cancel_all(Canceller& canceller, const Poll& poll);
  std::uint64_t steps_between_drops() const;
  template <class Graph>
  std::uint64_t drop_rows(const Graph& graph);
  bool next_ranked(RankedPair& ranked);

  SegmentStore& store_;
  const io::TempDir& temp_;
  MemoryBudget& budget_;
  const Options options_;
  const Shares shares_;
  const std::uint32_t nodes_, arcs_;
  std::optional<PagedTables> tables_;  // until all is cancelled
  StoredNodes node_data_;
  std::optional<BasicWorkingGraph<PagedTables>> graph_;
  std::optional<StoredLists> lists_;
  std::optional<IntroducedNodes> introduced_;  // when all is cancelled
  SortedPairs pairs_;
  RecordCursor<RankedPair> cursor_;  // in pairs_
  std::uint64_t pair_ = 0;           // number of the next pair
  std::vector<bool> kept_;           // by pair
  Reservation steps_charge_;
  std::vector<double> persistence_;
  std::vector<NodeId> isolated_;
  std::uint64_t spilled_ = 0, refetches_ = 0;
};

}  // namespace reeb::ooc
