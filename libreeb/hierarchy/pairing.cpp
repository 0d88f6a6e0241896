#include "libreeb/hierarchy/pairing.h"

#include <algorithm>
#include <utility>

#include "libreeb/hierarchy/pair_sweeps.h"

namespace reeb {
namespace {

// The arcs grouped by upper end: the arcs down from node y are order[first[y]] .. order[first[y + 1] - 1].
struct ArcsBelow {
  std::vector<std::uint32_t> first, order;
};

ArcsBelow arcs_below(const ReebGraph& graph) {
  ArcsBelow below{std::vector<std::uint32_t>(graph.node_count() + 1), std::vector<std::uint32_t>(graph.arc_count())};
  for (const NodeId hi : graph.hi) ++below.first[hi.value()];
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : below.first) sum += std::exchange(entry, sum);
  for (std::uint32_t arc = 0; arc < graph.arc_count(); ++arc) below.order[below.first[graph.hi[arc].value()]++] = arc;
  std::rotate(below.first.begin(), below.first.end() - 1, below.first.end());
  below.first[0] = 0;
  return below;
}

UpSweep sweep_up(const ReebGraph& graph, std::vector<PersistencePair>& pairs, const Poll& poll) {
  constexpr std::uint32_t kNodesBetweenPolls = 1u << 14;
  const ArcsBelow below = arcs_below(graph);
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  UpSweep sweep(nodes);
  for (std::uint32_t y = 0; y < nodes; ++y) {
    if (poll && y % kNodesBetweenPolls == 0) poll(static_cast<double>(y) / nodes);
    for (std::uint32_t i = below.first[y]; i < below.first[y + 1]; ++i)
      sweep.add(graph.lo[below.order[i]].value(), y, [&](const PersistencePair& pair) { pairs.push_back(pair); });
  }
  return sweep;
}

}  // namespace

void sort_for_cancelling(const ReebGraph& graph, std::vector<PersistencePair>& pairs) {
  std::vector<RankedPair> ranked;
  ranked.reserve(pairs.size());
  for (const PersistencePair& pair : pairs) ranked.push_back({persistence_of(graph, pair), pair});
  std::sort(ranked.begin(), ranked.end(), is_cancelled_before);
  std::transform(ranked.begin(), ranked.end(), pairs.begin(), [](const RankedPair& k) { return k.pair; });
}

std::vector<PersistencePair> persistence_pairs(const ReebGraph& graph, const Poll& poll) {
  std::vector<PersistencePair> pairs;
  const auto take = [&](const PersistencePair& pair) { pairs.push_back(pair); };
  {
    const auto nodes = static_cast<std::uint32_t>(graph.node_count());
    UpSweep up = sweep_up(graph, pairs, poll);
    DownSweep down(nodes);
    // Arcs are sorted by lower end.
    for (std::size_t arc = graph.arc_count(); arc-- > 0;) down.add(graph.lo[arc], graph.hi[arc], take);
    pair_components(nodes, up, down, take);
  }
  sort_for_cancelling(graph, pairs);
  return pairs;
}

}  // namespace reeb
