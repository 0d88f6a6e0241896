#include "tests/support/inputs/random_graph.h"

#include <algorithm>

#include "tests/model/plain_graph.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

ReebGraph random_graph(Random& random, std::size_t nodes, std::size_t arcs) {
  ReebGraph graph;
  // Values ascend along the numbers; a step of 0 makes a tie.
  const unsigned tie_percent = random.chance(50) ? 0 : 40;
  double value = 0;
  for (std::size_t v = 0; v < nodes; ++v) {
    graph.nodes.push_back({value, VertexId(v)});
    if (!random.chance(tie_percent)) value += 0.25 + random.unit();
  }
  const std::size_t reach = random.chance(50) ? nodes : 1 + nodes / 4;
  std::vector<std::pair<NodeId, NodeId>> ends;
  for (std::size_t i = 0; i < arcs && nodes > 1; ++i) {
    const std::size_t lo = random.below(nodes - 1);
    const std::size_t hi = lo + 1 + random.below(std::min(reach, nodes - 1 - lo));
    ends.emplace_back(NodeId(static_cast<std::uint32_t>(lo)), NodeId(static_cast<std::uint32_t>(hi)));
  }
  std::sort(ends.begin(), ends.end());
  for (const auto& [lo, hi] : ends) {
    graph.lo.push_back(lo);
    graph.hi.push_back(hi);
  }
  PlainGraph plain(graph);
  plain.contract_regular_nodes();
  return plain.graph();
}

}  // namespace

ReebGraph random_graph(std::uint64_t seed) {
  Random random(seed);
  const std::size_t nodes = random.between(1, 16);
  return random_graph(random, nodes, random.below(2 * nodes + 2));
}

ReebGraph random_graph(std::uint64_t seed, std::size_t arcs) {
  Random random(seed);
  return random_graph(random, 1 + arcs * 2 / 3, arcs);
}

}  // namespace reeb::test
