// Where settled nodes and arcs wait for the second stage: sorted, packed segments on disk
// (DESIGN.md 4, Spilling).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"
#include "ooc/external_sort.h"
#include "ooc/temp_dir.h"

namespace reeb::ooc {

// Columns of a block: value bits as differences (they rise), vertex ids as differences of either
// sign, the rest told from these; byte planes; zstd.
struct NodeCodec {
  static void encode(std::span<const SettledNode> nodes, std::vector<std::byte>& packed);
  static bool decode(std::span<const std::byte> packed, std::span<SettledNode> nodes);
};
struct ArcCodec {
  static void encode(std::span<const ArcKeys> arcs, std::vector<std::byte>& packed);
  static bool decode(std::span<const std::byte> packed, std::span<ArcKeys> arcs);
};
struct NodeLess {
  bool operator()(const SettledNode& a, const SettledNode& b) const { return a.key < b.key; }
};

// Pull interfaces: read(out, limit) delivers the next in order, rewind() starts again.
using SortedNodes = ExternalSort<SettledNode, NodeCodec, NodeLess>;
using SortedArcs = ExternalSort<ArcKeys, ArcCodec>;

struct SegmentOptions {
  std::uint64_t allowance_bytes = 8 << 20;  // of the budget, half for nodes and half for arcs
  bool background = true;                   // sort and write segments in threads of their own
  // For segments that another process may have to go on with: FILES.nodes and FILES.arcs. Else the
  // segments are in unnamed files.
  std::string files = {};
};

// Takes nodes and arcs in any order; after finish() it gives them back in canonical order (nodes
// by key, arcs by lo, then hi) as often as needed. While they fit the allowance no file is made.
//
// THROWS: Error{kResource} of the budget or the disk; what fails in the background is thrown by
//         the next call.
// MEMORY: the allowance.   THREADS: one at a time.
class SegmentStore : public GraphSink {
 public:
  SegmentStore(const TempDir& temp, MemoryBudget& budget, const SegmentOptions& options = {});

  void add_nodes(std::span<const SettledNode> nodes) override { nodes_.add(nodes); }
  void add_arcs(const SettledArcs& settled) override { arcs_.add(settled.arcs); }
  void finish();

  // As of ExternalSort; before finish().
  void save(StateWriter& out) {
    nodes_.save(out);
    arcs_.save(out);
  }
  void restore(StateReader& in) {
    nodes_.restore(in);
    arcs_.restore(in);
  }

  // REQUIRES: finish() was called.
  SortedNodes& nodes() { return nodes_; }
  SortedArcs& arcs() { return arcs_; }

  std::uint64_t node_count() const { return nodes_.size(); }
  std::uint64_t arc_count() const { return arcs_.size(); }
  std::uint64_t spilled_bytes() const { return nodes_.spilled_bytes() + arcs_.spilled_bytes(); }
  MemoryBudget& budget() { return *budget_; }

 private:
  MemoryBudget* budget_;
  SortedNodes nodes_;
  SortedArcs arcs_;
};

// A graph in memory with what it has reserved.
struct LoadedGraph {
  Reservation memory;
  ReebGraph graph;
};

// All of a finished store, for a second stage in memory. Positions are left empty unless wanted.
//
// THROWS: Error{kResource} if the graph does not fit the budget, before anything is read;
//         std::logic_error if an arc ends in no node.
LoadedGraph read_graph(SegmentStore& store, bool with_positions = true);

}  // namespace reeb::ooc
