// Nodes in the order in which a file introduces them: by frame, then by rank.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/settled_node.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/sorting/record_cursor.h"
#include "ooc/stored_hierarchy/stored_nodes.h"

namespace reeb::ooc {

// The nodes of a frame are anywhere in the total order. To look up each of them would read a page for each. So the
// frames are sorted by node first, then all nodes are read in their own order, and both together are sorted by frame.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: twice the allowance of a sort, at most.   THREADS: one at a time.
class IntroducedNodes {
 public:
  // REQUIRES: `temp` and `budget` outlive this.
  IntroducedNodes(const io::TempDir& temp, MemoryBudget& budget, const SortOptions& sorting)
      : temp_(temp),
        budget_(budget),
        sorting_(sorting),
        frames_(std::in_place, "frames of nodes", temp, budget, sorting) {}

  // To be called for each node once, in any order.
  void add(NodeId node, std::uint32_t frame) { frames_->add(Introduction{node, frame}); }

  // The data of this node. The first call reads all `nodes`. REQUIRES: nodes are asked for in the order above, after
  // all were added.
  // THROWS: std::logic_error if another node is next.
  SettledNode next(NodeId node, StoredNodes& nodes);

  std::uint64_t spilled_bytes() const {
    return spilled_ + (frames_ ? frames_->spilled_bytes() : 0) + (sorted_ ? sorted_->spilled_bytes() : 0);
  }

 private:
  struct Introduction {
    NodeId node;
    std::uint32_t frame = 0;
    friend bool operator<(const Introduction& a, const Introduction& b) { return a.node < b.node; }
  };
  struct Node {
    Introduction at;
    SettledNode node;
    friend bool operator<(const Node& a, const Node& b) {
      return a.at.frame < b.at.frame || (a.at.frame == b.at.frame && a.at.node < b.at.node);
    }
  };

  void sort(StoredNodes& nodes);

  const io::TempDir& temp_;
  MemoryBudget& budget_;
  const SortOptions sorting_;
  std::optional<ExternalSort<Introduction>> frames_;  // until sort()
  std::optional<ExternalSort<Node>> sorted_;
  RecordCursor<Node> cursor_;  // in sorted_
  std::uint64_t spilled_ = 0;
};

}  // namespace reeb::ooc
