// Pairs against the boundary-matrix reduction, against Betti numbers, and by hand.
#include "libreeb/hierarchy/pairing.h"

#include <gtest/gtest.h>

#include <functional>

#include "libreeb/hierarchy/pair_sweeps.h"
#include "tests/libreeb/hierarchy/random_graphs.h"
#include "tests/model/reference_pairs.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

// A second thread that is always faster, without a thread.
void elsewhere_first(const std::function<void()>& here, const std::function<void()>& elsewhere) {
  elsewhere();
  here();
}

SweepKey key(std::uint64_t i) { return {static_cast<double>(i), VertexId(i)}; }

ReebGraph graph_of(const std::vector<std::pair<std::uint64_t, std::uint64_t>>& arcs) {
  std::vector<ArcKeys> keys;
  for (const auto& [lo, hi] : arcs) keys.push_back({key(lo), key(hi)});
  return make_graph(std::move(keys), {});
}

std::size_t count(const std::vector<PersistencePair>& pairs, PairType type) {
  return static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [type](const auto& p) { return p.type == type; }));
}

TEST(Pairing, AnEmptyGraphHasNone) { EXPECT_TRUE(persistence_pairs(ReebGraph{}).empty()); }

TEST(Pairing, AnIsolatedNodeIsItsOwnComponent) {
  const std::vector<PersistencePair> expected{{NodeId(0), NodeId(0), PairType::kExt0}};
  EXPECT_EQ(persistence_pairs(make_graph({}, {key(7)})), expected);
}

TEST(Pairing, AnUprightTorusHasTheTextbookPairs) {
  const std::vector<PersistencePair> expected{{NodeId(1), NodeId(2), PairType::kExt1},
                                              {NodeId(0), NodeId(3), PairType::kExt0}};
  EXPECT_EQ(persistence_pairs(graph_of({{0, 1}, {1, 2}, {1, 2}, {2, 3}})), expected);
}

TEST(Pairing, AForkOfHighDegreeTakesPartOncePerArcButOne) {
  // Up-fork 1: three arcs meet again in 2, a fourth ends in the maximum 3, below the other, 4.
  const auto pairs = persistence_pairs(graph_of({{0, 1}, {1, 2}, {1, 2}, {1, 2}, {1, 3}, {2, 4}}));
  const std::vector<PersistencePair> expected{{NodeId(1), NodeId(2), PairType::kExt1},
                                              {NodeId(1), NodeId(2), PairType::kExt1},
                                              {NodeId(1), NodeId(3), PairType::kRel1},
                                              {NodeId(0), NodeId(4), PairType::kExt0}};
  EXPECT_EQ(pairs, expected);
}

TEST(Pairing, EqualPersistencesAreListedInsideOut) {
  // All values are equal: intervals are ordered by hi, then from the inside out.
  std::vector<ArcKeys> arcs;
  const auto flat = [](std::uint64_t i) { return SweepKey{1.0, VertexId(i)}; };
  for (const auto& [lo, hi] : {std::pair{0, 1}, {1, 2}, {2, 3}, {2, 3}, {3, 4}, {1, 4}, {4, 5}})
    arcs.push_back({flat(static_cast<std::uint64_t>(lo)), flat(static_cast<std::uint64_t>(hi))});
  const auto pairs = persistence_pairs(test::contracted(arcs, {}));
  const std::vector<PersistencePair> expected{{NodeId(2), NodeId(3), PairType::kExt1},
                                              {NodeId(1), NodeId(4), PairType::kExt1},
                                              {NodeId(0), NodeId(5), PairType::kExt0}};
  EXPECT_EQ(pairs, expected);
}

TEST(Pairing, EqualsTheBoundaryMatrixReduction) {
  for (std::uint64_t seed = 0; seed < 12000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const ReebGraph graph = test::random_graph(random, seed % 50 == 0 ? 40 : 11);
    const auto pairs = persistence_pairs(graph);
    ASSERT_EQ(test::vertex_pairs(graph, pairs), test::vertex_pairs(graph, test::reference_pairs(graph)));

    const BettiNumbers betti = betti_numbers(graph);
    ASSERT_EQ(count(pairs, PairType::kExt0), betti.components);
    ASSERT_EQ(count(pairs, PairType::kExt1), betti.loops);
  }
}

// Against the reduction of the complex itself, which needs no Reeb graph.
TEST(Pairing, EqualsTheBoundaryMatrixReductionOfComplexes) {
  const std::uint64_t base = test::base_seed();
  for (std::uint64_t i = 0; i < test::case_count(10000); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    const test::Complex complex = test::random_complex(base + i);
    if (complex.vertex_count() > 60) continue;  // the reduction is cubic
    const ReebGraph graph = test::reference_reeb(complex);
    ASSERT_EQ(test::vertex_pairs(graph, persistence_pairs(graph)), test::reference_pairs(complex));
  }
}

TEST(Pairing, IsSortedForCancelling) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const ReebGraph graph = test::random_graph(random, 12);
    const auto pairs = persistence_pairs(graph);
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      const PersistencePair &a = pairs[i - 1], &b = pairs[i];
      if (a.type != PairType::kExt0 && b.type == PairType::kExt0) continue;
      ASSERT_EQ(a.type == PairType::kExt0, b.type == PairType::kExt0);
      ASSERT_LE(persistence_of(graph, a), persistence_of(graph, b));
      if (persistence_of(graph, a) < persistence_of(graph, b)) continue;
      ASSERT_LE(a.hi, b.hi);
      if (a.hi == b.hi) {
        ASSERT_GE(a.lo, b.lo);
      }
    }
  }
}

TEST(Pairing, TheSweepsCanTakePlaceInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const ReebGraph graph = test::random_graph(random, 14);
    ASSERT_EQ(sorted_pairs(graph, swept_pairs(graph, {}, elsewhere_first)), persistence_pairs(graph));
  }
}

TEST(Pairing, DoesNotDependOnTheOrderOfArcsWithinANode) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const ReebGraph graph = test::random_graph(random, 14);
    std::vector<ArcKeys> arcs;
    for (std::size_t i = 0; i < graph.arc_count(); ++i)
      arcs.push_back({graph.nodes[graph.lo[i].value()], graph.nodes[graph.hi[i].value()]});
    std::vector<SweepKey> nodes = graph.nodes;
    std::shuffle(arcs.begin(), arcs.end(), random);
    std::shuffle(nodes.begin(), nodes.end(), random);
    ASSERT_EQ(persistence_pairs(make_graph(arcs, nodes)), persistence_pairs(graph));

    // Bypass the canonical order: shuffle the arcs that leave each node.
    ReebGraph shuffled = graph;
    for (std::size_t first = 0, last = 0; first < graph.arc_count(); first = last) {
      while (last < graph.arc_count() && graph.lo[last] == graph.lo[first]) ++last;
      std::shuffle(shuffled.hi.begin() + static_cast<std::ptrdiff_t>(first),
                   shuffled.hi.begin() + static_cast<std::ptrdiff_t>(last), random);
    }
    ASSERT_EQ(persistence_pairs(shuffled), persistence_pairs(graph));
  }
}

}  // namespace
}  // namespace reeb
