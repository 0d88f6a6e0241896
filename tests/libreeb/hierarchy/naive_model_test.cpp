// The hierarchy against copy-and-cancel: pairs, kept loops and the graph of every version.
#include <gtest/gtest.h>

#include <algorithm>

#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/levels.h"
#include "tests/model/naive_hierarchy.h"
#include "tests/model/reference_pairs.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_graph.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

void expect_same(const ReebGraph& graph) {
  const NaiveHierarchy naive = naive_hierarchy(graph, reference_pairs(graph));
  const Hierarchy hierarchy = build_hierarchy(graph);
  ASSERT_EQ(hierarchy.pairs, naive.pairs);
  ASSERT_EQ(hierarchy.persistence.size() + 1, naive.versions.size());
  for (std::uint32_t version = 0; version < naive.versions.size(); ++version)
    ASSERT_EQ(without_positions(graph_at(hierarchy, graph, version)), without_positions(naive.versions[version]))
        << "version " << version << " of\n"
        << describe(graph);
}

TEST(HierarchyAgainstNaive, EveryVersionOfSmallGraphs) {
  const std::uint64_t base = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000) && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    expect_same(random_graph(base + i));
  }
}

TEST(HierarchyAgainstNaive, EveryVersionOfGraphsWithManyLoops) {
  const std::uint64_t base = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000) / 20 && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    expect_same(random_graph(base + i, 60));
  }
}

// Trunks that start at a node of another trunk; some also end in one. All along a trunk there are arcs from minima far
// below. So cancelling zips long paths with many nodes of larger persistence. For maxima the same upside down.
ReebGraph brush(std::uint64_t seed, bool upside_down) {
  Random random(seed);
  std::vector<ArcKeys> arcs;
  std::uint64_t count = 0;
  const auto node = [&](double height) { return SweepKey{upside_down ? -height : height, VertexId(count++)}; };
  const auto minimum = [&] { return node(-2000 - static_cast<double>(random.below(100'000))); };
  const auto height = [&](const SweepKey& key) { return upside_down ? -key.value : key.value; };
  const auto join = [&](const SweepKey& a, const SweepKey& b) { arcs.push_back({std::min(a, b), std::max(a, b)}); };
  std::vector<std::vector<SweepKey>> trunks;
  for (std::size_t trunk = 0; trunk < 4; ++trunk) {
    const auto* from = trunk == 0 ? nullptr : &trunks[random.below(trunk)];
    std::vector<SweepKey> path{from == nullptr ? node(-1e6) : (*from)[random.below(from->size() - 1)]};
    std::vector<double> heights(1 + random.below(trunk == 0 ? 150 : 40));
    for (double& h : heights) h = std::max(height(path[0]), 0.0) + 1 + static_cast<double>(random.below(2000)) / 4;
    std::sort(heights.begin(), heights.end());
    for (const double h : heights) {
      if (path.size() > 1) join(minimum(), path.back());
      path.push_back(node(h));
      join(path[path.size() - 2], path.back());
    }
    if (from != nullptr && height(from->back()) > height(path.back()) && random.chance(30)) {
      join(minimum(), path.back());
      join(path.back(), from->back());
    }
    trunks.push_back(std::move(path));
  }
  return make_graph(std::move(arcs), {});
}

TEST(HierarchyAgainstNaive, EveryVersionOfGraphsWithLongPaths) {
  const std::uint64_t base = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000) / 20 && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    expect_same(brush(base + i, i % 2 == 0));
  }
}

}  // namespace
}  // namespace reeb::test
