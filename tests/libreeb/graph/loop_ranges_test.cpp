// The smallest loops through arcs, against a search in every interlevel set.
#include "libreeb/graph/loop_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "libreeb/containers/union_find.h"
#include "libreeb/hierarchy/pairing.h"
#include "tests/support/inputs/random_graph.h"

namespace reeb {
namespace {

// Whether the ends of the arc are connected without it, by arcs between the nodes b and t.
bool on_cycle_within(const ReebGraph& graph, std::size_t arc, std::uint32_t b, std::uint32_t t) {
  if (graph.lo[arc].value() < b || graph.hi[arc].value() > t) return false;
  UnionFind sets(static_cast<std::uint32_t>(graph.node_count()));
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    if (i != arc && graph.lo[i].value() >= b && graph.hi[i].value() <= t)
      sets.unite(graph.lo[i].value(), graph.hi[i].value());
  return sets.find(graph.lo[arc].value()) == sets.find(graph.hi[arc].value());
}

double least_range(const ReebGraph& graph, std::size_t arc) {
  double least = kNoLoop;
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  for (std::uint32_t b = 0; b < nodes; ++b)
    for (std::uint32_t t = b + 1; t < nodes; ++t) {
      const double range = graph.nodes[t].value - graph.nodes[b].value;
      if (on_cycle_within(graph, arc, b, t) && (least == kNoLoop || range < least)) least = range;
    }
  return least;
}

TEST(LoopRanges, AreThoseOfTheSmallestCycle) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const ReebGraph graph = seed % 4 == 0 ? test::random_graph(seed, 40) : test::random_graph(seed);
    const std::vector<double> ranges = loop_ranges(graph);
    ASSERT_EQ(ranges.size(), graph.arc_count());
    for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
      ASSERT_EQ(ranges[arc], least_range(graph, arc)) << "seed " << seed << ", arc " << arc;
  }
}

TEST(LoopRanges, ArePersistencesOfLoops) {
  const ReebGraph graph = test::random_graph(7, 3000);
  std::vector<double> persistences{kNoLoop};
  for (const PersistencePair& pair : persistence_pairs(graph))
    if (pair.type == PairType::kExt1) persistences.push_back(persistence_of(graph, pair));
  std::ranges::sort(persistences);
  std::size_t loops = 0;
  for (const double range : loop_ranges(graph)) {
    EXPECT_TRUE(std::ranges::binary_search(persistences, range));
    loops += range == kNoLoop ? 0u : 1u;
  }
  EXPECT_GT(loops, 100u);
}

// Such arcs seemed to be on no loop.
TEST(LoopRanges, BeyondTheDoubles) {
  ReebGraph graph;
  for (const double value : {-1.7e308, 1.6e308, 1.7e308}) graph.nodes.push_back({value, VertexId(graph.nodes.size())});
  graph.lo = {NodeId(0), NodeId(0), NodeId(1)};
  graph.hi = {NodeId(1), NodeId(1), NodeId(2)};
  constexpr double kGreatest = std::numeric_limits<double>::max();
  EXPECT_EQ(loop_ranges(graph), (std::vector{kGreatest, kGreatest, kNoLoop}));
}

TEST(LoopRanges, OfNothing) { EXPECT_TRUE(loop_ranges(ReebGraph{}).empty()); }

}  // namespace
}  // namespace reeb
