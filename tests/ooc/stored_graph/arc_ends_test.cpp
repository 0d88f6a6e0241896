// Which short arcs are kept, against a search of the graph.
#include "ooc/stored_graph/arc_ends.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libreeb/containers/union_find.h"
#include "tests/libreeb/hierarchy/random_buckets.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

using test::Random;

ArcKeys keys_of(const ReebGraph& graph, std::size_t arc) {
  return {graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]};
}

// By node: whether arcs with `chosen` connect it to such an arc that ends in an extremum.
std::vector<bool> near_extrema(const ReebGraph& graph, const std::vector<bool>& chosen) {
  const Degrees degree = degrees(graph);
  UnionFind joined(static_cast<std::uint32_t>(graph.node_count()));
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
    if (chosen[arc]) joined.unite(graph.lo[arc].value(), graph.hi[arc].value());
  std::vector<bool> has_extremum(graph.node_count()), near(graph.node_count());
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const std::uint32_t lo = graph.lo[arc].value(), hi = graph.hi[arc].value();
    if (chosen[arc] && (degree.down[lo] == 0 || degree.up[hi] == 0)) has_extremum[joined.find(lo)] = true;
  }
  for (std::uint32_t node = 0; node < near.size(); ++node) near[node] = has_extremum[joined.find(node)];
  return near;
}

TEST(ArcEnds, KeepsWhatIsConnectedToAnExtremum) {
  const std::uint64_t seed = test::base_seed(), cases = test::case_count(500);
  std::size_t kept = 0, dropped = 0;
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", case " << i);
    Random random(seed + i);
    const ReebGraph graph = test::random_embedded_graph(random, 40).graph;
    std::uint64_t vertices = 0;
    for (const SweepKey& node : graph.nodes) vertices = std::max(vertices, node.vertex.value() + 1);
    ArcEnds ends(vertices);
    std::vector<bool> chosen(graph.arc_count());
    std::vector<ArcKeys> arcs, expected;
    for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
      ends.add(keys_of(graph, arc));
      chosen[arc] = test::below(random, 3) == 0;
    }
    const std::vector<bool> near = near_extrema(graph, chosen);
    for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
      if (!chosen[arc]) continue;
      arcs.push_back(keys_of(graph, arc));
      if (near[graph.lo[arc].value()]) expected.push_back(arcs.back());
    }
    dropped += arcs.size() - expected.size();
    kept += expected.size();
    EXPECT_EQ(ends.connected_to_extrema(arcs), expected);
  }
  EXPECT_GT(kept, cases);
  EXPECT_GT(dropped, cases / 2);
}

// Each round advances one arc along a chain whose arcs are in reverse order. Another arc of the same trunk, far above,
// is not connected to it.
TEST(ArcEnds, KeepsAllWhereItIsLongToTell) {
  const auto arc = [](std::uint64_t n) {
    return ArcKeys{{static_cast<double>(n), VertexId(n)}, {static_cast<double>(n + 1), VertexId(n + 1)}};
  };
  constexpr std::uint64_t kTrunk = 1000;
  for (const std::uint64_t chain : {4u, 900u}) {
    ArcEnds ends(kTrunk + 1);
    for (std::uint64_t n = 0; n < kTrunk; ++n) ends.add(arc(n));
    std::vector<ArcKeys> arcs{arc(kTrunk - 50)};
    for (std::uint64_t n = chain; n-- > 0;) arcs.push_back(arc(n));
    EXPECT_EQ(ends.connected_to_extrema(arcs).size(), chain < 16 ? chain : chain + 1);
  }
}

}  // namespace
}  // namespace reeb::ooc
