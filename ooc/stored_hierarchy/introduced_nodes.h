// Nodes in the order in which a file introduces them: by frame, then by rank.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/settled_node.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/stored_hierarchy/stored_nodes.h"

namespace reeb::ooc {

// The nodes of a frame are anywhere in the total order, and reading each of them where it is would read a page for
// each. So frames are sorted by node, meet the nodes in their order, and both are sorted by frame.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: twice the allowance of a sort, at most.   THREADS: one at a time.
class IntroducedNodes {
 public:
  // REQUIRES: `temp` and `budget` outlive this.
  IntroducedNodes(const io::TempDir& temp, MemoryBudget& budget, const SortOptions& sorting)
      : temp_(temp), budget_(budget), sorting_(sorting) {
    frames_.emplace("frames of nodes", temp, budget, sorting);
  }

  // To be called for each node once, in any order.
  void add(NodeId node, std::uint32_t frame) { frames_->add(Introduction{node, frame}); }

  // The next node in order, which is this one. The first call reads all `nodes`.
  // THROWS: std::logic_error if another one is next.
  SettledNode next(NodeId node, StoredNodes& nodes);

  std::uint64_t spilled_bytes() const {
    return spilled_ + (frames_ ? frames_->spilled_bytes() : 0) + (sorted_ ? sorted_->spilled_bytes() : 0);
  }

 private:
  static constexpr std::size_t kAtOnce = 4096;  // records that are read
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
  std::vector<Node> batch_;  // of sorted_, the next of which is at_
  std::size_t at_ = 0;
  std::uint64_t spilled_ = 0;
};

}  // namespace reeb::ooc
