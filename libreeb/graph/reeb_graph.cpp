#include "libreeb/graph/reeb_graph.h"

#include <algorithm>

#include "libreeb/containers/union_find.h"

namespace reeb {
namespace {

NodeId rank_of(const std::vector<SweepKey>& nodes, const SweepKey& key) {
  const auto it = std::lower_bound(nodes.begin(), nodes.end(), key);
  return NodeId(static_cast<std::uint32_t>(it - nodes.begin()));
}

}  // namespace

ReebGraph make_graph(std::vector<ArcKeys> arcs, std::vector<SweepKey> isolated) {
  ReebGraph graph;
  graph.nodes = std::move(isolated);
  graph.nodes.reserve(graph.nodes.size() + 2 * arcs.size());
  for (const ArcKeys& arc : arcs) {
    graph.nodes.push_back(arc.lo);
    graph.nodes.push_back(arc.hi);
  }
  std::sort(graph.nodes.begin(), graph.nodes.end());
  graph.nodes.erase(std::unique(graph.nodes.begin(), graph.nodes.end()), graph.nodes.end());
  graph.nodes.shrink_to_fit();

  std::sort(arcs.begin(), arcs.end());
  graph.lo.reserve(arcs.size());
  graph.hi.reserve(arcs.size());
  for (const ArcKeys& arc : arcs) {
    graph.lo.push_back(rank_of(graph.nodes, arc.lo));
    graph.hi.push_back(rank_of(graph.nodes, arc.hi));
  }
  return graph;
}

void ReebGraph::validate() const {
  const auto fail = [](const std::string& what) { throw BrokenGraph("ReebGraph: " + what); };
  for (std::size_t i = 1; i < nodes.size(); ++i)
    if (!(nodes[i - 1] < nodes[i])) fail("node " + std::to_string(i) + " is not above the one before it");
  if (!positions.empty() && positions.size() != nodes.size()) fail("positions do not match nodes");
  if (lo.size() != hi.size()) fail("arc ends do not match");
  for (std::size_t i = 0; i < lo.size(); ++i) {
    if (!(lo[i] < hi[i]) || hi[i].value() >= nodes.size())
      fail("arc " + std::to_string(i) + " goes from " + std::to_string(lo[i].value()) + " to " +
           std::to_string(hi[i].value()));
    if (i > 0 && (lo[i] < lo[i - 1] || (lo[i] == lo[i - 1] && hi[i] < hi[i - 1])))
      fail("arc " + std::to_string(i) + " is out of order");
  }
}

Degrees degrees(const ReebGraph& graph) {
  Degrees d{std::vector<std::uint32_t>(graph.node_count()), std::vector<std::uint32_t>(graph.node_count())};
  for (const NodeId n : graph.lo) ++d.up[n.value()];
  for (const NodeId n : graph.hi) ++d.down[n.value()];
  return d;
}

BettiNumbers betti_numbers(const ReebGraph& graph) {
  UnionFind sets(static_cast<std::uint32_t>(graph.node_count()));
  std::uint64_t components = graph.node_count();
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    if (sets.unite(graph.lo[i].value(), graph.hi[i].value())) --components;
  return {components, graph.arc_count() + components - graph.node_count()};
}

}  // namespace reeb
