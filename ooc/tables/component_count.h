// The number of components of a graph whose nodes need not fit in memory.
#pragma once

#include <cstdint>
#include <optional>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/containers/union_find.h"
#include "ooc/tables/partition_logs.h"

namespace reeb::ooc {

// Takes the edges of a graph on nodes 0..n-1 and counts how many of them join two components.
//
// If the budget permits, the nodes are in one UnionFind. Else edges go to files, divided by their upper end into ranges
// of nodes that fit in memory. Ranges are contracted from the highest to the lowest. Within a range, each set of nodes
// is joined to at most one node below the range; an edge that would join it to a second one is replaced by an edge
// between these two nodes, which belongs to a lower range. All of this is read and written in order. A table of pages
// would be read at random.
//
// MEMORY: reserved: 4 bytes per node if there is that much; else about 900 bytes times the square root of n.
// THROWS: Error{kResource} of the budget or the disk.   THREADS: one at a time.
class ComponentCount {
 public:
  // `budget` and `temp` may be null: then memory is not counted.
  ComponentCount(std::uint64_t nodes, const io::TempDir* temp, MemoryBudget* budget);

  // REQUIRES: lo < hi < nodes.
  void add(std::uint64_t lo, std::uint64_t hi) {
    if (ranges_)
      add_to_range(lo, hi);
    else
      joined_ += sets_.unite(static_cast<std::uint32_t>(lo), static_cast<std::uint32_t>(hi)) ? 1u : 0u;
  }

  // Prefetches what add() reads of a node. REQUIRES: node < nodes.
  void prefetch(std::uint64_t node) const {
    if (!ranges_) sets_.prefetch(static_cast<std::uint32_t>(node));
  }

  // The number of edges so far that joined two components: the graph has n minus this many. Ends adding.
  std::uint64_t joined();
  std::uint64_t spilled_bytes() const { return ranges_ ? ranges_->spilled_bytes() : 0; }

 private:
  struct Edge {
    std::uint64_t lo, hi;
  };

  void add_to_range(std::uint64_t lo, std::uint64_t hi) {
    ranges_->append(static_cast<std::size_t>(hi / range_nodes_), {lo, hi});
  }
  void divide(std::uint64_t nodes, const io::TempDir& temp, MemoryBudget& budget);
  void contract(std::size_t range);

  Reservation memory_;
  UnionFind sets_;
  std::uint64_t range_nodes_ = 0;
  std::size_t range_count_ = 0;
  std::optional<PartitionLogs<Edge>> ranges_;
  std::uint64_t joined_ = 0;
};

}  // namespace reeb::ooc
