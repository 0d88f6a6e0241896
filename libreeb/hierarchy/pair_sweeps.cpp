#include "libreeb/hierarchy/pair_sweeps.h"

#include <algorithm>
#include <utility>

#include "libreeb/base/prefetch.h"
#include "libreeb/hierarchy/pairing.h"

namespace reeb {
namespace {

// The ends of an arc can be anywhere in memory. So the sweeps prefetch what the arc this many places later needs.
constexpr std::size_t kArcsAhead = 16;

// The arcs grouped by upper end: the arcs down from node y lead to lower[first[y]] .. lower[first[y + 1] - 1].
struct ArcsBelow {
  std::vector<std::uint32_t> first, lower;
};

ArcsBelow arcs_below(const ReebGraph& graph) {
  ArcsBelow below{std::vector<std::uint32_t>(graph.node_count() + 1), std::vector<std::uint32_t>(graph.arc_count())};
  for (const NodeId hi : graph.hi) ++below.first[hi.value()];
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : below.first) sum += std::exchange(entry, sum);
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
    below.lower[below.first[graph.hi[arc].value()]++] = graph.lo[arc].value();
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
    for (std::size_t i = below.first[y]; i < below.first[y + 1]; ++i) {
      if (i + kArcsAhead < below.lower.size()) sweep.prefetch(below.lower[i + kArcsAhead]);
      sweep.add(below.lower[i], y, [&](const PersistencePair& pair) { pairs.push_back(pair); });
    }
  }
  return sweep;
}

DownSweep sweep_down(const ReebGraph& graph, std::vector<PersistencePair>& pairs) {
  DownSweep sweep(static_cast<std::uint32_t>(graph.node_count()));
  // Arcs are sorted by lower end.
  for (std::size_t arc = graph.arc_count(); arc-- > 0;) {
    if (arc >= kArcsAhead) sweep.prefetch(graph.hi[arc - kArcsAhead]);
    sweep.add(graph.lo[arc], graph.hi[arc], [&](const PersistencePair& pair) { pairs.push_back(pair); });
  }
  return sweep;
}

// In the order of cancelling.
std::vector<RankedPair> ranked(const ReebGraph& graph, const std::vector<PersistencePair>& pairs) {
  constexpr std::size_t kPairsAhead = 16;
  std::vector<RankedPair> result;
  result.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i + kPairsAhead < pairs.size())
      for (const NodeId node : {pairs[i + kPairsAhead].lo, pairs[i + kPairsAhead].hi})
        prefetch(&graph.nodes[node.value()]);
    result.push_back({persistence_of(graph, pairs[i]), pairs[i]});
  }
  std::sort(result.begin(), result.end(), is_cancelled_before);
  return result;
}

}  // namespace

void sort_for_cancelling(const ReebGraph& graph, std::vector<PersistencePair>& pairs) {
  const std::vector<RankedPair> sorted = ranked(graph, pairs);
  std::ranges::transform(sorted, pairs.begin(), &RankedPair::pair);
}

SweptPairs swept_pairs(const ReebGraph& graph, const Poll& poll, const DoBoth& both) {
  SweptPairs pairs;
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  UpSweep up(0);
  DownSweep down(0);
  const auto sweep_upwards = [&] { up = sweep_up(graph, pairs.rising, poll); };
  const auto sweep_downwards = [&] {
    std::vector<PersistencePair> falling;
    down = sweep_down(graph, falling);
    pairs.falling = ranked(graph, falling);
  };
  do_both(both, sweep_upwards, sweep_downwards);
  pair_components(nodes, up, down, [&](const PersistencePair& pair) { pairs.components.push_back(pair); });
  return pairs;
}

std::vector<PersistencePair> sorted_pairs(const ReebGraph& graph, SweptPairs pairs) {
  const std::vector<RankedPair> rising = ranked(graph, pairs.rising);
  pairs.rising = {};
  std::vector<PersistencePair> all;
  all.reserve(rising.size() + pairs.falling.size() + pairs.components.size());
  for (auto a = rising.begin(), b = pairs.falling.cbegin(); a != rising.end() || b != pairs.falling.end();) {
    const bool takes_a = b == pairs.falling.end() || (a != rising.end() && is_cancelled_before(*a, *b));
    all.push_back((takes_a ? a++ : b++)->pair);
  }
  sort_for_cancelling(graph, pairs.components);
  all.insert(all.end(), pairs.components.begin(), pairs.components.end());
  return all;
}

}  // namespace reeb
