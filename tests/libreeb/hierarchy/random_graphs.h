// Small random Reeb graphs of every kind that the second stage has to process.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::test {

using Random = std::mt19937_64;

inline std::uint32_t below(Random& random, std::uint32_t bound) { return static_cast<std::uint32_t>(random() % bound); }

// Contracts all (1, 1) nodes, and makes the graph.
inline ReebGraph contracted(std::vector<ArcKeys> arcs, std::vector<SweepKey> isolated) {
  for (std::size_t i = 0; i < arcs.size();) {
    const SweepKey middle = arcs[i].hi;
    const auto down = std::count_if(arcs.begin(), arcs.end(), [&](const ArcKeys& a) { return a.hi == middle; });
    const auto up = std::count_if(arcs.begin(), arcs.end(), [&](const ArcKeys& a) { return a.lo == middle; });
    if (down != 1 || up != 1) {
      ++i;
      continue;
    }
    const auto next = std::find_if(arcs.begin(), arcs.end(), [&](const ArcKeys& a) { return a.lo == middle; });
    arcs[i].hi = next->hi;
    arcs.erase(next);
    i = 0;
  }
  return make_graph(std::move(arcs), std::move(isolated));
}

// Arcs between up to `max_nodes` nodes: a multigraph, a forest, a ladder or bundles of parallel arcs; with isolated
// nodes, and values that are distinct, partly tied, or all equal.
inline ReebGraph random_graph(Random& random, std::uint32_t max_nodes) {
  const std::uint32_t nodes = 2 + below(random, max_nodes - 1);
  const std::uint32_t values = 1 + below(random, 2) * below(random, 3 * nodes);
  std::vector<SweepKey> keys;
  for (std::uint32_t i = 0; i < nodes; ++i)
    keys.push_back({static_cast<double>(below(random, values)) - 2, VertexId(i)});
  std::shuffle(keys.begin(), keys.end(), random);

  std::vector<ArcKeys> arcs;
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    if (a != b) arcs.push_back({std::min(keys[a], keys[b]), std::max(keys[a], keys[b])});
  };
  const std::uint32_t kind = below(random, 5);
  if (kind == 0)  // forest
    for (std::uint32_t i = 1; i < nodes; ++i) join(i, below(random, i));
  if (kind == 1) {  // ladder: two monotone rails and rungs
    std::sort(keys.begin(), keys.end());
    for (std::uint32_t i = 2; i < nodes; ++i) join(i - 2, i);
    for (std::uint32_t i = 1; i < nodes; ++i)
      if (below(random, 2) == 0) join(i - 1, i);
  }
  if (kind == 2)  // bundles
    for (std::uint32_t i = 0; i < nodes; ++i) {
      const std::uint32_t a = below(random, nodes), b = below(random, nodes);
      for (std::uint32_t k = below(random, 4); k > 0; --k) join(a, b);
    }
  if (kind >= 3)  // multigraph
    for (std::uint32_t i = below(random, 3 * nodes); i > 0; --i) join(below(random, nodes), below(random, nodes));

  std::vector<SweepKey> isolated;
  for (std::uint32_t i = below(random, 3); i > 0; --i)
    isolated.push_back({static_cast<double>(below(random, values)), VertexId(nodes + i)});
  return contracted(std::move(arcs), std::move(isolated));
}

}  // namespace reeb::test
