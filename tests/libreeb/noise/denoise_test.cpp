// Noise removal against a naive repetition of its definition, in any order of leaves.
#include "libreeb/noise/denoise.h"

#include <gtest/gtest.h>

#include "libreeb/hierarchy/pairing.h"
#include "tests/libreeb/hierarchy/random_graphs.h"
#include "tests/model/reference_pairs.h"

namespace reeb {
namespace {

// Whether a monotone path from `from` in the direction of `leaf` reaches beyond the leaf.
bool reaches_beyond(const std::vector<ArcKeys>& arcs, const SweepKey& from, const SweepKey& leaf, bool up) {
  if (up ? leaf < from : from < leaf) return true;
  return std::any_of(arcs.begin(), arcs.end(), [&](const ArcKeys& a) {
    return (up ? a.lo : a.hi) == from && reaches_beyond(arcs, up ? a.hi : a.lo, leaf, up);
  });
}

// Arcs that end in removable leaves.
std::vector<std::size_t> removable(const std::vector<ArcKeys>& arcs, double threshold) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < arcs.size(); ++i)
    for (const bool up : {false, true}) {
      const SweepKey leaf = up ? arcs[i].hi : arcs[i].lo, saddle = up ? arcs[i].lo : arcs[i].hi;
      const auto uses =
          std::count_if(arcs.begin(), arcs.end(), [&](const ArcKeys& a) { return a.lo == leaf || a.hi == leaf; });
      if (uses == 1 && arcs[i].hi.value - arcs[i].lo.value < threshold && reaches_beyond(arcs, saddle, leaf, up))
        found.push_back(i);
    }
  return found;
}

ReebGraph naive_denoise(const ReebGraph& full, double threshold, test::Random& random) {
  std::vector<SweepKey> isolated;
  const Degrees d = degrees(full);
  for (std::size_t i = 0; i < full.node_count(); ++i)
    if (d.down[i] + d.up[i] == 0) isolated.push_back(full.nodes[i]);
  ReebGraph graph = full;
  while (true) {
    std::vector<ArcKeys> arcs;
    for (std::size_t i = 0; i < graph.arc_count(); ++i)
      arcs.push_back({graph.nodes[graph.lo[i].value()], graph.nodes[graph.hi[i].value()]});
    const auto leaves = removable(arcs, threshold);
    if (leaves.empty()) return graph;
    arcs.erase(arcs.begin() + static_cast<std::ptrdiff_t>(leaves[random() % leaves.size()]));
    graph = test::contracted(arcs, isolated);
  }
}

TEST(Denoise, EqualsTheDefinitionInAnyOrder) {
  std::size_t removed = 0;
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const ReebGraph full = test::random_graph(random, 12);
    const double threshold = static_cast<double>(test::below(random, 24));
    const Denoised result = denoise(full, threshold);
    ASSERT_NO_THROW(result.graph.validate());
    ASSERT_EQ(result.graph, naive_denoise(full, threshold, random));
    removed += result.removed.size();

    // The remaining pairs and the removed ones together are the pairs of the full graph.
    auto pairs = test::vertex_pairs(result.graph, test::reference_pairs(result.graph));
    for (const auto& key : test::vertex_pairs(full, result.removed)) pairs.push_back(key);
    std::sort(pairs.begin(), pairs.end());
    ASSERT_EQ(pairs, test::vertex_pairs(full, test::reference_pairs(full)));
    for (const PersistencePair& pair : result.removed) {
      ASSERT_LT(persistence_of(full, pair), threshold);
      ASSERT_TRUE(pair.type == PairType::kOrd0 || pair.type == PairType::kRel1);
    }
  }
  EXPECT_GT(removed, 1000u);
}

TEST(Denoise, AtThresholdZeroChangesNothing) {
  test::Random random(1);
  const ReebGraph full = test::random_graph(random, 40);
  EXPECT_EQ(denoise(full, 0).graph, full);
  EXPECT_TRUE(denoise(full, 0).removed.empty());
}

TEST(Denoise, PositionsStayWithTheirNodes) {
  ReebGraph full = make_graph({{{0, VertexId(0)}, {4, VertexId(1)}},
                               {{4, VertexId(1)}, {5, VertexId(2)}},
                               {{4, VertexId(1)}, {9, VertexId(3)}}},
                              {});
  full.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  const Denoised result = denoise(full, 2);
  EXPECT_EQ(result.graph.positions, (std::vector<std::array<double, 3>>{{0, 0, 0}, {3, 3, 3}}));
  EXPECT_EQ(result.removed, (std::vector<PersistencePair>{{NodeId(1), NodeId(2), PairType::kRel1}}));
}

}  // namespace
}  // namespace reeb
