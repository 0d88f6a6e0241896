#include "tests/model/naive_denoise.h"

#include <algorithm>
#include <utility>
#include <vector>

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
    if (is_noise_above(graph, node, full, threshold) || is_noise_below(graph, node, full, threshold))
      leaves.push_back(node);
  return leaves;
}

// A graph as its arcs, named by the ranks of their ends in the full graph. It has no nodes without arcs.
class ArcGraph {
 public:
  ArcGraph(const ReebGraph& full, double threshold) : full_(full), threshold_(threshold) {
    for (std::size_t a = 0; a < full.arc_count(); ++a) arcs_.push_back({full.lo[a].value(), full.hi[a].value()});
    std::vector<bool> has_arc(full.node_count());
    for (const auto& [lo, hi] : arcs_) has_arc[lo] = has_arc[hi] = true;
    for (std::size_t n = 0; n < full.node_count(); ++n)
      if (!has_arc[n]) isolated_.push_back(full.nodes[n]);
  }

  // Removes the leaves that are noise now, and returns their number.
  std::size_t remove_leaves() {
    look();
    const auto is_noise = [&](const Arc& arc) {
      if (!(full_.nodes[arc.hi].value - full_.nodes[arc.lo].value < threshold_)) return false;
      return (up_[arc.hi] == 0 && down_[arc.hi] == 1 && highest_[arc.lo] > arc.hi) ||
             (down_[arc.lo] == 0 && up_[arc.lo] == 1 && lowest_[arc.hi] < arc.lo);
    };
    return std::erase_if(arcs_, is_noise);
  }

  void contract() {
    look();
    const auto is_regular = [&](Node n) { return up_[n] == 1 && down_[n] == 1; };
    std::vector<Node> above(full_.node_count());
    for (const auto& [lo, hi] : arcs_) above[lo] = hi;  // of a regular node, the only one
    for (Arc& arc : arcs_)
      while (is_regular(arc.hi)) arc.hi = above[arc.hi];
    std::erase_if(arcs_, [&](const Arc& arc) { return is_regular(arc.lo); });
  }

  ReebGraph graph() const {
    std::vector<ArcKeys> keys;
    for (const auto& [lo, hi] : arcs_) keys.push_back({full_.nodes[lo], full_.nodes[hi]});
    return make_graph(std::move(keys), isolated_);
  }

 private:
  struct Arc {
    Node lo, hi;
  };

  // Degrees, and the farthest nodes that each reaches upward and downward.
  void look() {
    const std::size_t n = full_.node_count();
    up_.assign(n, 0);
    down_.assign(n, 0);
    highest_.resize(n);
    lowest_.resize(n);
    for (Node i = 0; i < n; ++i) highest_[i] = lowest_[i] = i;
    for (const auto& [lo, hi] : arcs_) ++up_[lo], ++down_[hi];
    // Arcs are sorted by lower end. So forward, all arcs below an arc come before it; backward, all arcs above it.
    std::sort(arcs_.begin(), arcs_.end(), [](const Arc& a, const Arc& b) { return a.lo < b.lo; });
    for (auto arc = arcs_.rbegin(); arc != arcs_.rend(); ++arc)
      highest_[arc->lo] = std::max(highest_[arc->lo], highest_[arc->hi]);
    for (const auto& [lo, hi] : arcs_) lowest_[hi] = std::min(lowest_[hi], lowest_[lo]);
  }

  const ReebGraph& full_;
  double threshold_;
  std::vector<Arc> arcs_;
  std::vector<SweepKey> isolated_;
  std::vector<std::uint32_t> up_, down_;
  std::vector<Node> highest_, lowest_;
};

}  // namespace

Denoised naive_denoise(const ReebGraph& graph, double threshold, std::uint64_t seed) {
  Random random(seed);
  PlainGraph current(graph);
  Denoised result;
  for (auto leaves = noise(current, graph, threshold); !leaves.empty(); leaves = noise(current, graph, threshold)) {
    current.remove_node(leaves[random.below(leaves.size())]);
    current.contract_regular_nodes();
    ++result.removed_pairs;
  }
  result.graph = current.graph();
  return result;
}

Denoised denoise_in_rounds(const ReebGraph& graph, double threshold) {
  ArcGraph current(graph, threshold);
  Denoised result;
  while (const std::size_t removed = current.remove_leaves()) {
    result.removed_pairs += removed;
    current.contract();
  }
  result.graph = current.graph();
  return result;
}

}  // namespace reeb::test
