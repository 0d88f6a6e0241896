#include "libreeb/segmentation/arc_chains.h"

#include <algorithm>

namespace reeb {
namespace {

constexpr ArcId kNoArc = ArcId::none();

std::vector<NodeId> own_numbers(std::size_t count) {
  std::vector<NodeId> numbers(count);
  for (std::size_t n = 0; n < count; ++n) numbers[n] = NodeId(static_cast<std::uint32_t>(n));
  return numbers;
}

}  // namespace

// Arcs are sorted by their lower ends.
std::vector<NodeId> highest_above(const ReebGraph& graph) {
  std::vector<NodeId> highest = own_numbers(graph.node_count());
  for (std::size_t a = graph.arc_count(); a-- > 0;) {
    NodeId& below = highest[graph.lo[a].value()];
    below = std::max(below, highest[graph.hi[a].value()]);
  }
  return highest;
}

ArcChains::ArcChains(const ReebGraph& graph) : chain_of_(graph.arc_count()) {
  std::vector<NodeId> reach = highest_above(graph);
  std::vector<ArcId> up(graph.node_count(), kNoArc), down(graph.node_count(), kNoArc);
  for (std::uint32_t a = 0; a < graph.arc_count(); ++a) {
    ArcId& best = up[graph.lo[a].value()];
    if (best == kNoArc || reach[graph.hi[a].value()] > reach[graph.hi[best.value()].value()]) best = ArcId(a);
  }
  reach = own_numbers(graph.node_count());
  for (std::uint32_t a = 0; a < graph.arc_count(); ++a) {
    // All arcs that end in the lower node are before this one.
    const NodeId lowest = reach[graph.lo[a].value()];
    NodeId& above = reach[graph.hi[a].value()];
    ArcId& best = down[graph.hi[a].value()];
    if (best == kNoArc || lowest < above) best = ArcId(a);
    above = std::min(above, lowest);
  }
  for (std::uint32_t a = 0; a < graph.arc_count(); ++a) {
    const NodeId start = graph.lo[a];
    if (up[start.value()] == ArcId(a) && down[start.value()] != kNoArc) continue;  // goes on from below
    first_.push_back(static_cast<std::uint32_t>(arcs_.size()));
    for (ArcId at(a);;) {
      chain_of_[at.value()] = static_cast<std::uint32_t>(first_.size() - 1);
      arcs_.push_back(at);
      const NodeId end = graph.hi[at.value()];
      if (down[end.value()] != at || up[end.value()] == kNoArc) break;
      at = up[end.value()];
    }
  }
  first_.push_back(static_cast<std::uint32_t>(arcs_.size()));
}

}  // namespace reeb
