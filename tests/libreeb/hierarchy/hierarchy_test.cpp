// Every version of small hierarchies: the diagram loses exactly the pair of its step. Rules with a unique result are
// checked on graphs drawn by hand.
#include <gtest/gtest.h>

#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/levels.h"
#include "libreeb/hierarchy/pairing.h"
#include "tests/libreeb/hierarchy/random_graphs.h"
#include "tests/model/reference_pairs.h"

namespace reeb {
namespace {

using ArcList = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

ReebGraph graph_of(const ArcList& arcs) {
  std::vector<ArcKeys> keys;
  for (const auto& [lo, hi] : arcs)
    keys.push_back({{static_cast<double>(lo), VertexId(lo)}, {static_cast<double>(hi), VertexId(hi)}});
  return make_graph(std::move(keys), {});
}

ArcList arcs_of(const ReebGraph& graph) {
  ArcList arcs;
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    arcs.emplace_back(graph.nodes[graph.lo[i].value()].vertex.value(), graph.nodes[graph.hi[i].value()].vertex.value());
  return arcs;
}

// The arcs after cancelling below t.
ArcList level(const ArcList& arcs, double t) {
  const ReebGraph full = graph_of(arcs);
  const Hierarchy h = build_hierarchy(full);
  return arcs_of(graph_at(h, full, version_below(h, t)));
}

void expect_no_regular_node(const ReebGraph& graph) {
  const Degrees d = degrees(graph);
  for (std::size_t i = 0; i < graph.node_count(); ++i) ASSERT_FALSE(d.down[i] == 1 && d.up[i] == 1) << "node " << i;
}

TEST(Hierarchy, OfAnEmptyGraphIsEmpty) {
  const Hierarchy h = build_hierarchy({});
  EXPECT_TRUE(h.pairs.empty());
  EXPECT_TRUE(h.arcs.empty());
  EXPECT_EQ(graph_at(h, {}, 0), ReebGraph{});
}

TEST(Hierarchy, AMaximumIsLaidOnTheOtherBranch) { EXPECT_EQ(level({{0, 4}, {4, 5}, {4, 9}}, 2), (ArcList{{0, 9}})); }

TEST(Hierarchy, AThresholdIsStrict) {
  const ArcList arcs{{0, 4}, {4, 5}, {4, 9}};
  EXPECT_EQ(level(arcs, 1), arcs);
  EXPECT_EQ(level(arcs, 1.5), (ArcList{{0, 9}}));
}

TEST(Hierarchy, AMaximumsPathGoesIntoTheArcWithTheLowestUpperNode) {
  // From 4 up: to the maximum 6 past the down-fork 5, to the up-fork 7, or directly to 20.
  const ArcList arcs{{0, 4}, {1, 5}, {4, 5}, {5, 6}, {4, 7}, {7, 18}, {7, 19}, {4, 20}};
  EXPECT_EQ(level(arcs, 2.5), (ArcList{{0, 4}, {1, 5}, {4, 5}, {4, 20}, {5, 7}, {7, 18}, {7, 19}}));
}

TEST(Hierarchy, AMinimumIsTheMirrorImage) {
  const ArcList arcs{{20 - 4, 20},     {20 - 5, 19},      {20 - 5, 20 - 4},  {20 - 6, 20 - 5},
                     {20 - 7, 20 - 4}, {20 - 18, 20 - 7}, {20 - 19, 20 - 7}, {0, 20 - 4}};
  EXPECT_EQ(level(arcs, 2.5), (ArcList{{0, 16}, {1, 13}, {2, 13}, {13, 15}, {15, 16}, {15, 19}, {16, 20}}));
}

TEST(Hierarchy, AnArcOfALoopIsTakenAway) {
  EXPECT_EQ(level({{0, 1}, {1, 2}, {1, 2}, {2, 3}}, 2), (ArcList{{0, 3}}));
  EXPECT_EQ(level({{0, 5}, {1, 7}, {5, 7}, {5, 8}, {7, 8}, {8, 20}}, 3.5), (ArcList{{0, 7}, {1, 7}, {7, 20}}));
}

TEST(Hierarchy, TwoPathsAroundALoopAreZipped) {
  // Left 12-13-16 with a branch down at 13, right 12-14-16 with a branch up at 14.
  const ArcList arcs{{0, 12}, {1, 13}, {12, 13}, {12, 14}, {13, 16}, {14, 16}, {14, 40}, {16, 41}};
  EXPECT_EQ(level(arcs, 4.5), (ArcList{{0, 13}, {1, 13}, {13, 14}, {14, 40}, {14, 41}}));
}

TEST(Hierarchy, OfThreePathsTheFirstTwoAreZipped) {
  const ArcList arcs{{0, 10},  {1, 11},  {2, 12},  {3, 13},  {10, 11}, {10, 12},
                     {10, 13}, {11, 14}, {12, 14}, {13, 14}, {14, 30}};
  const ReebGraph full = graph_of(arcs);
  const Hierarchy h = build_hierarchy(full);
  ASSERT_EQ(h.pairs[0].type, PairType::kExt1);
  EXPECT_EQ(arcs_of(graph_at(h, full, 1)),
            (ArcList{{0, 10}, {1, 11}, {2, 12}, {3, 13}, {10, 11}, {10, 13}, {11, 12}, {12, 14}, {13, 14}, {14, 30}}));
}

TEST(Hierarchy, ALoopWithoutTwoMonotonePathsIsKept) {
  // Paths up from v = 10 lead to y = 14 through 11, and to 13; 13 is connected with y through 12 only.
  const ArcList arcs{{0, 10}, {10, 11}, {1, 11}, {11, 14}, {10, 13}, {12, 13}, {2, 12}, {12, 14}, {13, 30}, {14, 31}};
  const ReebGraph full = graph_of(arcs);
  const Hierarchy h = build_hierarchy(full);
  ASSERT_EQ(h.pairs[0].type, PairType::kExt1);
  EXPECT_EQ(full.nodes[h.pairs[0].lo.value()].vertex, VertexId(10));
  EXPECT_EQ(full.nodes[h.pairs[0].hi.value()].vertex, VertexId(14));
  EXPECT_TRUE(h.pairs[0].kept);
  EXPECT_EQ(betti_numbers(graph_at(h, full, last_version(h))).loops, 1u);
}

// The same loop (110, 114), kept. The maximum 130 is then zipped onto the path to 114. That leaves two monotone paths
// 110-111-114 and 110-113-114, in one component above 110.
ArcList around_a_kept_loop(const ArcList& more) {
  ArcList arcs{{0, 110}, {110, 111}, {1, 111}, {111, 114}, {110, 113}, {112, 113}, {2, 112}, {112, 114}, {113, 130}};
  arcs.insert(arcs.end(), more.begin(), more.end());
  return arcs;
}

TEST(Hierarchy, AMaximumAboveAKeptLoopIsLaidOutsideItsComponent) {
  EXPECT_EQ(level(around_a_kept_loop({{114, 131}, {110, 150}}), 22),
            (ArcList{{0, 110}, {1, 111}, {2, 113}, {110, 111}, {110, 113}, {111, 114}, {113, 114}, {114, 150}}));
}

TEST(Hierarchy, ALoopAroundAKeptLoopIsZippedWithAnotherComponent) {
  EXPECT_EQ(level(around_a_kept_loop({{114, 140}, {110, 116}, {3, 116}, {116, 140}, {140, 160}}), 31),
            (ArcList{{0, 110},
                     {1, 111},
                     {2, 113},
                     {3, 116},
                     {110, 111},
                     {110, 113},
                     {111, 114},
                     {113, 114},
                     {114, 116},
                     {116, 160}}));
}

TEST(Hierarchy, AnArcThatAStepLeavesAsItWasKeepsItsRecord) {
  // Cancelling (4, 5) cuts the arc (4, 9) at 5 and joins it again.
  const ReebGraph full = graph_of({{0, 4}, {1, 4}, {4, 5}, {4, 9}});
  const Hierarchy h = build_hierarchy(full);
  const std::vector<ArcVersion> expected{{NodeId(0), NodeId(4), 2, kNeverDies},
                                         {NodeId(0), NodeId(2), 0, 2},
                                         {NodeId(1), NodeId(2), 0, 2},
                                         {NodeId(2), NodeId(4), 0, 2},
                                         {NodeId(2), NodeId(3), 0, 1}};
  EXPECT_EQ(h.arcs, expected);
}

class RandomHierarchies : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomHierarchies, EveryStepRemovesExactlyItsPair) {
  for (std::uint64_t seed = 0; seed < 36000 / GetParam(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const ReebGraph full = test::random_graph(random, GetParam());
    const Hierarchy h = build_hierarchy(full);
    ASSERT_EQ(graph_at(h, full, version_below(h, 0)), full);
    ASSERT_TRUE(std::is_sorted(h.persistence.begin(), h.persistence.end()));

    const auto sizes = level_sizes(h);
    ASSERT_EQ(sizes.size(), last_version(h) + 1);
    std::vector<PersistencePair> left = h.pairs;
    auto next = left.begin();
    for (std::uint32_t version = 0;; ++version) {
      SCOPED_TRACE(testing::Message() << "version " << version);
      const ReebGraph graph = graph_at(h, full, version);
      graph.validate();
      expect_no_regular_node(graph);
      ASSERT_EQ(sizes[version].nodes, graph.node_count());
      ASSERT_EQ(sizes[version].arcs, graph.arc_count());
      ASSERT_EQ(finest_with_nodes(sizes, graph.node_count()),
                static_cast<std::uint32_t>(std::find_if(sizes.begin(), sizes.end(),
                                                        [&](const auto& s) { return s.nodes <= graph.node_count(); }) -
                                           sizes.begin()));
      ASSERT_EQ(test::vertex_pairs(graph, test::reference_pairs(graph)), test::vertex_pairs(full, left));
      while (next != left.end() && (next->kept || next->type == PairType::kExt0)) ++next;
      if (next == left.end()) {
        ASSERT_EQ(version, last_version(h));
        break;
      }
      ASSERT_EQ(h.persistence[version], persistence_of(full, *next));
      next = left.erase(next);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Nodes, RandomHierarchies, testing::Values(6, 12, 24));

TEST(Hierarchy, SomeRandomLoopsAreZippedAndSomeKept) {
  std::size_t kept = 0, loops = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    test::Random random(seed);
    for (const PersistencePair& pair : build_hierarchy(test::random_graph(random, 24)).pairs) {
      kept += pair.kept;
      loops += pair.type == PairType::kExt1;
      EXPECT_TRUE(!pair.kept || pair.type == PairType::kExt1);
    }
  }
  EXPECT_GT(kept, 0u) << "rule (c) is not exercised";
  EXPECT_LT(kept * 4, loops);
}

}  // namespace
}  // namespace reeb
