// The keys and positions of nodes in pages, by rank.
#pragma once

#include <cstdint>

#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/graph/settled_node.h"
#include "ooc/stored_hierarchy/paged_rows.h"

namespace reeb::ooc {

// THROWS, MEMORY, THREADS: as PagedRows.
class StoredNodes {
 public:
  StoredNodes(const io::TempDir& temp, MemoryBudget& budget, std::uint32_t nodes, std::uint64_t allowance_bytes)
      : rows_(temp, budget, nodes, sizeof(SweepKey) + sizeof(Point), allowance_bytes),
        keys_(rows_.add_column(SweepKey{})),
        positions_(rows_.add_column(Point{})) {}

  SweepKey key(NodeId node) { return rows_.get(keys_, node.value()); }
  Point position(NodeId node) { return rows_.get(positions_, node.value()); }
  SettledNode node(NodeId node) { return {key(node), position(node)}; }
  void set(NodeId node, const SettledNode& to) {
    rows_.change(keys_, node.value()) = to.key;
    rows_.change(positions_, node.value()) = to.position;
  }

  std::uint64_t spilled_bytes() const { return rows_.pages().spilled_bytes(); }

 private:
  PagedRows rows_;
  PagedRows::Column<SweepKey> keys_;
  PagedRows::Column<Point> positions_;
};

}  // namespace reeb::ooc
