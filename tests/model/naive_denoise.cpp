#include "tests/model/naive_denoise.h"

#include "tests/model/plain_graph.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

using Node = PlainGraph::Node;

// A maximum u with one arc, of persistence below t, from whose saddle another path leads beyond u.
bool is_noise_above(const PlainGraph& graph, Node u, const ReebGraph& full, double threshold) {
  const std::vector<Node> below = graph.down(u);
  if (below.size() != 1 || !graph.up(u).empty()) return false;
  const Node saddle = below.front();
  if (!(full.nodes[u].value - full.nodes[saddle].value < threshold)) return false;
  for (const Node beyond : graph.nodes())
    if (beyond > u && graph.leads_up(saddle, beyond)) return true;
  return false;
}

bool is_noise_below(const PlainGraph& graph, Node u, const ReebGraph& full, double threshold) {
  const std::vector<Node> above = graph.up(u);
  if (above.size() != 1 || !graph.down(u).empty()) return false;
  const Node saddle = above.front();
  if (!(full.nodes[saddle].value - full.nodes[u].value < threshold)) return false;
  for (const Node beyond : graph.nodes())
    if (beyond < u && graph.leads_up(beyond, saddle)) return true;
  return false;
}

std::vector<Node> noise(const PlainGraph& graph, const ReebGraph& full, double threshold) {
  std::vector<Node> leaves;
  for (const Node node : graph.nodes())
    if (is_noise_above(graph, node, full, threshold) ||
        is_noise_below(graph, node, full, threshold))
      leaves.push_back(node);
  return leaves;
}

}  // namespace

Denoised naive_denoise(const ReebGraph& graph, double threshold, std::uint64_t seed) {
  Random random(seed);
  PlainGraph current(graph);
  Denoised result;
  for (auto leaves = noise(current, graph, threshold); !leaves.empty();
       leaves = noise(current, graph, threshold)) {
    current.remove_node(leaves[random.below(leaves.size())]);
    current.contract_regular_nodes();
    ++result.removed_pairs;
  }
  result.graph = current.graph();
  return result;
}

}  // namespace reeb::test
