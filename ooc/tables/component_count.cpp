#include "ooc/tables/component_count.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb::ooc {
namespace {

constexpr const char* kOwner = "components";
constexpr std::uint64_t kNoNode = ~std::uint64_t{0};
constexpr std::uint64_t kNodeBytes = sizeof(std::uint32_t), kRangeNodeBytes = kNodeBytes + sizeof(std::uint64_t);

}  // namespace

ComponentCount::ComponentCount(std::uint64_t nodes, const io::TempDir* temp, MemoryBudget* budget) {
  if (temp != nullptr && budget != nullptr) {
    memory_ = budget->try_reserve(kOwner, nodes * kNodeBytes);
    if (memory_.bytes() != nodes * kNodeBytes) {
      divide(nodes, *temp, *budget);
      return;
    }
  }
  sets_ = UnionFind(static_cast<std::uint32_t>(nodes));
}

// The nodes of a range take the same memory as the buffers of all ranges: that minimizes the sum.
void ComponentCount::divide(std::uint64_t nodes, const io::TempDir& temp, MemoryBudget& budget) {
  constexpr double kBytes = static_cast<double>(PartitionLogs<Edge>::kBlockBytes) / kRangeNodeBytes;
  range_nodes_ = static_cast<std::uint64_t>(std::sqrt(kBytes * static_cast<double>(nodes))) + 1;
  range_count_ = static_cast<std::size_t>((nodes + range_nodes_ - 1) / range_nodes_);
  memory_ = budget.reserve(kOwner, range_nodes_ * kRangeNodeBytes);
  ranges_.emplace(kOwner, temp, budget, range_count_);
}

std::uint64_t ComponentCount::joined() {
  for (; range_count_ > 0; --range_count_) contract(range_count_ - 1);
  return joined_;
}

void ComponentCount::contract(std::size_t range) {
  const std::uint64_t first = range * range_nodes_;
  UnionFind sets(static_cast<std::uint32_t>(range_nodes_));
  std::vector<std::uint64_t> below(static_cast<std::size_t>(range_nodes_), kNoNode);  // by set: joined to this node
  // Records that `set` is also connected to `node`.
  const auto connect = [&](std::uint32_t set, std::uint64_t node) {
    if (below[set] == kNoNode) {
      below[set] = node;
      ++joined_;
    } else if (below[set] != node) {
      const auto [lo, hi] = std::minmax(below[set], node);
      add_to_range(lo, hi);
    }
  };
  for (std::uint64_t left = ranges_->count(range); left > 0; --left) {
    const Edge edge = ranges_->next(range);
    const std::uint32_t hi = sets.find(static_cast<std::uint32_t>(edge.hi - first));
    if (edge.lo < first) {
      connect(hi, edge.lo);
      continue;
    }
    const std::uint32_t lo = sets.find(static_cast<std::uint32_t>(edge.lo - first));
    if (!sets.unite(lo, hi)) continue;
    const auto [root, rest] = std::minmax(lo, hi);  // as UnionFind links
    const std::uint64_t other = std::exchange(below[rest], kNoNode);
    // If both sets are joined to nodes below, an edge between those nodes replaces this one.
    if (other == kNoNode)
      ++joined_;
    else
      connect(root, other);
  }
}

}  // namespace reeb::ooc
