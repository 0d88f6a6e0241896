// The arcs of a graph as monotone chains: at each node, the chain from the lowest minimum goes on to the highest
// maximum. What follows the surface over many small branches stays in one chain.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// TIME: linear in the graph.   MEMORY: kArcBytes per arc; during construction, kWorkingNodeBytes per node.
class ArcChains {
 public:
  static constexpr std::uint64_t kArcBytes = 12, kWorkingNodeBytes = 16;

  explicit ArcChains(const ReebGraph& graph);

  std::uint32_t chain_count() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  std::uint32_t chain_of(ArcId arc) const { return chain_of_[arc.value()]; }
  // From below; each begins where the one before ends.
  std::span<const ArcId> arcs(std::uint32_t chain) const {
    return std::span(arcs_).subspan(first_[chain], first_[chain + 1] - first_[chain]);
  }

 private:
  std::vector<std::uint32_t> chain_of_;  // by arc
  std::vector<std::uint32_t> first_;     // by chain: into arcs_
  std::vector<ArcId> arcs_;
};

// By node: the highest node to which a monotone path leads up.
std::vector<NodeId> highest_above(const ReebGraph& graph);

}  // namespace reeb
