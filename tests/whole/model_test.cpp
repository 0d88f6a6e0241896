// Tests of the models themselves: on graphs known by hand, against counts that need no graph, and against each other. A
// fault that these tests miss is missed by the engine's tests, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "tests/model/naive_denoise.h"
#include "tests/model/naive_hierarchy.h"
#include "tests/model/reference_pairs.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/inputs/random_graph.h"
#include "tests/support/inputs/shapes.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

using Arcs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
using Vertices = std::vector<std::uint64_t>;

Vertices nodes_of(const ReebGraph& graph) {
  Vertices nodes;
  for (const SweepKey& node : graph.nodes) nodes.push_back(node.vertex.value());
  return nodes;
}

Arcs arcs_of(const ReebGraph& graph) {
  Arcs arcs;
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    arcs.emplace_back(graph.nodes[graph.lo[i].value()].vertex.value(), graph.nodes[graph.hi[i].value()].vertex.value());
  return arcs;
}

void expect_graph(const Complex& complex, const Vertices& nodes, const Arcs& arcs) {
  const ReebGraph graph = reference_reeb(complex);
  graph.validate();
  EXPECT_EQ(nodes_of(graph), nodes) << describe(complex);
  EXPECT_EQ(arcs_of(graph), arcs) << describe(complex);
}

TEST(ReferenceReeb, HasNoNodesForAnEmptyInput) { expect_graph(make_complex({}, {}), {}, {}); }

TEST(ReferenceReeb, KeepsIsolatedVerticesInTheTotalOrder) {
  expect_graph(make_complex({2, 1, 1}, {{2}}), {1, 2, 0}, {});
}

TEST(ReferenceReeb, MapsSimplicesOfAnyDimensionToAnArc) {
  const std::vector<double> values{3, 1, 4, 0, 5, 2};
  for (std::size_t corners = 2; corners <= values.size(); ++corners) {
    Complex complex = make_complex({values.begin(), values.begin() + std::ptrdiff_t(corners)}, {{}});
    for (std::size_t v = 0; v < corners; ++v) complex.simplices.front().push_back(v);
    const std::vector<std::uint64_t> order = sweep_order(complex);
    expect_graph(complex, {order.front(), order.back()}, {{order.front(), order.back()}});
  }
}

TEST(ReferenceReeb, MapsTheBoundaryOfATriangleToALoop) {
  expect_graph(make_complex({0, 1, 2}, {{0, 1}, {1, 2}, {2, 0}}), {0, 2}, {{0, 2}, {0, 2}});
}

TEST(ReferenceReeb, MapsTheBoundaryOfATetrahedronToAnArc) {
  expect_graph(make_complex({0, 1, 2, 3}, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}), {0, 3}, {{0, 3}});
}

TEST(ReferenceReeb, SettlesTiesByIndex) {
  // Two triangles at the edge (1, 2), whose upper corner is 2 by index: both others are above it.
  expect_graph(make_complex({1, 0, 0, 1}, {{0, 1, 2}, {3, 2, 1}}), {1, 2, 0, 3}, {{1, 2}, {2, 0}, {2, 3}});
}

TEST(ReferenceReeb, TakesMinusZeroForZero) {
  expect_graph(make_complex({0.0, -0.0, 0.0}, {{1, 0}, {1, 2}}), {0, 2}, {{0, 2}});
  EXPECT_FALSE(std::signbit(reference_reeb(make_complex({-0.0}, {})).nodes[0].value));
}

TEST(ReferenceReeb, TakesADegenerateTriangleForAnEdge) {
  expect_graph(make_complex({0, 1, 2}, {{0, 2, 0}, {1, 1, 1}, {1, 2, 2}}), {0, 1, 2}, {{0, 2}, {1, 2}});
}

TEST(ReferenceReeb, DoesNotCountARepeatedSimplexTwice) {
  expect_graph(make_complex({0, 1}, {{0, 1}, {1, 0}, {0, 1, 1}}), {0, 1}, {{0, 1}});
}

TEST(ReferenceReeb, KeepsTheFoldOfAMonkeySaddle) {
  // Vertex 0 in the middle of a closed fan that goes up and down three times around it.
  Complex complex = fan(6, true);
  complex.values = {0, -1, 1, -2, 2, -3, 3};
  expect_graph(complex, {5, 3, 1, 0, 2, 4, 6}, {{5, 0}, {3, 0}, {1, 0}, {0, 2}, {0, 4}, {0, 6}});
}

TEST(ReferenceReeb, SeesTheHoleOfAnUprightTorus) {
  for (const std::size_t rings : {8u, 13u}) {
    const ReebGraph graph = reference_reeb(upright_torus(rings, 6));
    EXPECT_EQ(graph.node_count(), 4u);
    const Vertices n = nodes_of(graph);
    EXPECT_EQ(arcs_of(graph), (Arcs{{n[0], n[1]}, {n[1], n[2]}, {n[1], n[2]}, {n[2], n[3]}}));
  }
}

TEST(ReferenceReeb, MapsAPlateauAndATiedStripToOneArc) {
  expect_graph(plateau(4, 3), {0, 19}, {{0, 19}});
  expect_graph(tied_strip(7, 2), {0, 23}, {{0, 23}});
}

TEST(ReferenceReeb, BranchesAtABooksSpine) { expect_graph(book(3), {0, 1, 2, 3, 4}, {{0, 1}, {1, 2}, {1, 3}, {1, 4}}); }

TEST(ReferenceReeb, HasAsManyLoopsAsTheGenusAtMost) {
  const std::uint64_t seed = base_seed();
  std::uint64_t most = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto genus = static_cast<unsigned>(i % 4);
    Complex complex = closed_surface(genus, 3 + i % 3, 3 + i % 2);
    set_random_values(complex, seed + i);
    const ReebGraph graph = reference_reeb(complex);
    graph.validate();
    EXPECT_EQ(betti_numbers(graph).components, 1u);
    EXPECT_LE(betti_numbers(graph).loops, genus) << describe(complex);
    most = std::max(most, betti_numbers(graph).loops);
  }
  EXPECT_GT(most, 1u) << "the surfaces are not what they should be";
}

TEST(Shapes, HaveTheirEulerCharacteristic) {
  const auto euler = [](const Complex& complex) {
    const Skeleton skeleton = two_skeleton(complex);
    return static_cast<int>(complex.vertex_count() + skeleton.triangles.size()) -
           static_cast<int>(skeleton.edges.size());
  };
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kDisc)), 1);
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kCylinder)), 0);
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kMoebius)), 0);
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kTorus)), 0);
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kKlein)), 0);
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kProjective)), 1);
  EXPECT_EQ(euler(glued_grid(4, 4, Gluing::kSphere)), 2);
  for (unsigned genus = 0; genus < 4; ++genus)
    EXPECT_EQ(euler(closed_surface(genus, 4, 3)), 2 - 2 * static_cast<int>(genus));
}

TEST(ReferencePairs, AreThoseOfGraphsKnownByHand) {
  using enum PairType;
  const auto pairs = [](std::vector<double> values, std::vector<Vertices> simplices) {
    const ReebGraph graph = reference_reeb(make_complex(std::move(values), std::move(simplices)));
    std::vector<std::tuple<PairType, std::uint64_t, std::uint64_t>> result;
    for (const VertexPair& pair : vertex_pairs(graph, reference_pairs(graph)))
      result.emplace_back(pair.type, pair.lo.value(), pair.hi.value());
    return result;
  };
  using Expected = decltype(pairs({}, {}));
  EXPECT_EQ(pairs({5}, {}), (Expected{{kExt0, 0, 0}}));
  EXPECT_EQ(pairs({0, 1}, {{0, 1}}), (Expected{{kExt0, 0, 1}}));
  // A Y has one maximum more, its mirror image one minimum more.
  EXPECT_EQ(pairs({0, 1, 2, 3}, {{0, 1}, {1, 2}, {1, 3}}), (Expected{{kExt0, 0, 3}, {kRel1, 1, 2}}));
  EXPECT_EQ(pairs({3, 2, 1, 0}, {{0, 1}, {1, 2}, {1, 3}}), (Expected{{kExt0, 3, 0}, {kOrd0, 2, 1}}));
  // Three up-arcs: the two lower maxima die in the fork.
  EXPECT_EQ(pairs({0, 1, 2, 3}, {{0, 1}, {0, 2}, {0, 3}}), (Expected{{kExt0, 0, 3}, {kRel1, 0, 1}, {kRel1, 0, 2}}));
  // A triangle's boundary, and a loop with a tail at either end.
  EXPECT_EQ(pairs({0, 1, 2}, {{0, 1}, {1, 2}, {0, 2}}), (Expected{{kExt0, 0, 2}, {kExt1, 0, 2}}));
  EXPECT_EQ(pairs({0, 1, 2, 3, 4, 5}, {{0, 1}, {1, 2}, {1, 3}, {2, 4}, {3, 4}, {4, 5}}),
            (Expected{{kExt0, 0, 5}, {kExt1, 1, 4}}));
}

TEST(Models, AgreeOnRandomComplexes) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(3000); ++i) {
    const Complex complex = random_complex(seed + i);
    if (complex.vertex_count() > 60) continue;
    SCOPED_TRACE(describe(complex));
    const ReebGraph graph = reference_reeb(complex);
    graph.validate();
    const Degrees degree = degrees(graph);
    for (std::size_t v = 0; v < graph.node_count(); ++v) ASSERT_FALSE(degree.down[v] == 1 && degree.up[v] == 1);
    const auto pairs = reference_pairs(graph);
    const auto count = [&](PairType type) {
      return static_cast<std::uint64_t>(
          std::count_if(pairs.begin(), pairs.end(), [&](const PersistencePair& p) { return p.type == type; }));
    };
    ASSERT_EQ(count(PairType::kExt0), component_count(complex));
    ASSERT_EQ(count(PairType::kExt0), betti_numbers(graph).components);
    ASSERT_EQ(count(PairType::kExt1), betti_numbers(graph).loops);
    ASSERT_EQ(vertex_pairs(graph, pairs), reference_pairs(complex));
  }
}

// The pairs of `before` without one that equals `pair`.
std::vector<VertexPair> without(std::vector<VertexPair> before, const VertexPair& pair) {
  const auto it = std::find(before.begin(), before.end(), pair);
  if (it != before.end()) before.erase(it);
  return before;
}

struct HierarchyCounts {
  std::uint64_t steps = 0, loops = 0, kept = 0;
};

// Each cancellation removes exactly its pair.
void check_hierarchy(const ReebGraph& graph, HierarchyCounts& counts) {
  SCOPED_TRACE(describe(graph));
  const NaiveHierarchy hierarchy = naive_hierarchy(graph, reference_pairs(graph));
  ASSERT_EQ(hierarchy.versions.size(), hierarchy.steps.size() + 1);
  std::vector<VertexPair> expected = vertex_pairs(graph, reference_pairs(graph));
  for (std::size_t s = 0; s < hierarchy.steps.size(); ++s) {
    const PersistencePair& pair = hierarchy.pairs[hierarchy.steps[s]];
    const ReebGraph& version = hierarchy.versions[s + 1];
    version.validate();
    expected = without(expected, vertex_pairs(graph, {pair}).front());
    ASSERT_EQ(vertex_pairs(version, reference_pairs(version)), expected)
        << "after step " << s + 1 << ", pair " << static_cast<int>(pair.type) << ' '
        << graph.nodes[pair.lo.value()].vertex.value() << ' ' << graph.nodes[pair.hi.value()].vertex.value()
        << "\nbefore:\n"
        << describe(hierarchy.versions[s]) << "after:\n"
        << describe(version);
  }
  counts.steps += hierarchy.steps.size();
  for (const PersistencePair& pair : hierarchy.pairs) {
    if (pair.type == PairType::kExt1) ++counts.loops;
    if (pair.kept) ++counts.kept;
  }
}

TEST(NaiveHierarchy, RemovesExactlyItsPairAtEachStepOfAComplexsGraph) {
  const std::uint64_t seed = base_seed();
  HierarchyCounts counts;
  for (std::uint64_t i = 0; i < case_count(2000) && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    if (complex.vertex_count() <= 40) check_hierarchy(reference_reeb(complex), counts);
  }
  EXPECT_GT(counts.loops, 0u);
  EXPECT_LT(counts.kept, counts.loops);
}

TEST(NaiveHierarchy, RemovesExactlyItsPairAtEachStepOfARandomGraph) {
  const std::uint64_t seed = base_seed();
  HierarchyCounts counts;
  for (std::uint64_t i = 0; i < case_count(2000) && !HasFatalFailure(); ++i)
    check_hierarchy(random_graph(seed + i), counts);
  EXPECT_LT(counts.kept, counts.loops);
}

// The graph of a complex of edges, one arc per edge, named by the values of its ends.
struct ValueGraph {
  explicit ValueGraph(const std::vector<std::pair<double, double>>& arcs) {
    std::set<double> distinct;
    for (const auto& [lo, hi] : arcs) distinct.insert({lo, hi});
    const std::vector<double> values(distinct.begin(), distinct.end());
    const auto node = [&](double value) {
      return static_cast<std::uint64_t>(std::distance(distinct.begin(), distinct.find(value)));
    };
    std::vector<Vertices> edges;
    for (const auto& [lo, hi] : arcs) edges.push_back({node(lo), node(hi)});
    graph = reference_reeb(make_complex(values, edges));
    hierarchy = naive_hierarchy(graph, reference_pairs(graph));
  }

  std::vector<std::pair<double, double>> arcs_of_version(std::size_t version) const {
    const ReebGraph& level = hierarchy.versions.at(version);
    std::vector<std::pair<double, double>> arcs;
    for (std::size_t i = 0; i < level.arc_count(); ++i)
      arcs.emplace_back(level.nodes[level.lo[i].value()].value, level.nodes[level.hi[i].value()].value);
    return arcs;
  }

  ReebGraph graph;
  NaiveHierarchy hierarchy;
};
using ValueArcs = std::vector<std::pair<double, double>>;

TEST(NaiveHierarchy, ZipsAMaximumOntoTheLowestOtherPath) {
  // Rel1 (0, 2): 0 -> 1.5 -> 2 is zipped onto 0 -> 1 -> 5, and 1.5 keeps its branch to -50.
  const ValueGraph g({{-60, 0}, {0, 1.5}, {-50, 1.5}, {1.5, 2}, {0, 1}, {1, 5}, {1, 6}});
  EXPECT_EQ(g.arcs_of_version(1), (ValueArcs{{-60, 1}, {-50, 1.5}, {1, 1.5}, {1, 6}, {1.5, 5}}));
}

TEST(NaiveHierarchy, ZipsAMinimumAsTheMirrorImage) {
  const ValueGraph g({{0, 60}, {-1.5, 0}, {-1.5, 50}, {-2, -1.5}, {-1, 0}, {-5, -1}, {-6, -1}});
  EXPECT_EQ(g.arcs_of_version(1), (ValueArcs{{-6, -1}, {-5, -1.5}, {-1.5, -1}, {-1.5, 50}, {-1, 60}}));
}

TEST(NaiveHierarchy, TakesAwayTheArcOfALoop) {
  const ValueGraph g({{-200, 0}, {0, 10}, {0, 1}, {1, 100}, {1, 10}, {10, 300}});
  EXPECT_EQ(g.arcs_of_version(1), (ValueArcs{{-200, 1}, {1, 100}, {1, 300}}));
}

TEST(NaiveHierarchy, ZipsTheFirstTwoPathsOfALoop) {
  const ValueGraph g(
      {{-200, 0}, {0, 1}, {1, 100}, {1, 10}, {0, 2}, {2, 110}, {2, 10}, {0, 3}, {3, 120}, {3, 10}, {10, 300}});
  EXPECT_EQ(g.arcs_of_version(1),
            (ValueArcs{{-200, 0}, {0, 1}, {0, 3}, {1, 2}, {1, 100}, {2, 10}, {2, 110}, {3, 10}, {3, 120}, {10, 300}}));
  EXPECT_EQ(g.arcs_of_version(2), (ValueArcs{{-200, 1}, {1, 2}, {1, 100}, {2, 3}, {2, 110}, {3, 120}, {3, 300}}));
}

TEST(NaiveHierarchy, KeepsALoopThatNoTwoPathsSpan) {
  // 0 -> 1.5 -> 3 and 0 -> 2 <- 1 -> 3, and a branch at each node that outlives the loop.
  const ValueGraph g({{0, 1.5}, {1.5, 3}, {0, 2}, {1, 2}, {1, 3}, {-90, 0}, {-100, 1}, {1.5, 80}, {2, 100}, {3, 90}});
  const PersistencePair& loop = g.hierarchy.pairs.front();
  EXPECT_EQ(loop.type, PairType::kExt1);
  EXPECT_TRUE(loop.kept);
  EXPECT_EQ(persistence(g.graph, loop), 3.0);
  EXPECT_EQ(g.hierarchy.versions.size(), g.hierarchy.pairs.size() - 1);
  EXPECT_EQ(betti_numbers(g.hierarchy.versions.back()).loops, 1u);
  HierarchyCounts counts;
  check_hierarchy(g.graph, counts);
}

TEST(NaiveHierarchy, RemovesExactlyItsPairAtEachStepOfALargerGraph) {
  const std::uint64_t seed = base_seed();
  HierarchyCounts counts;
  for (std::uint64_t i = 0; i < 60 && !HasFatalFailure(); ++i) check_hierarchy(random_graph(seed + i, 60), counts);
  EXPECT_GT(counts.kept, 0u) << "rule (c) was never met";
}

TEST(NaiveHierarchy, CutsBelowAThresholdStrictly) {
  const ReebGraph graph = reference_reeb(make_complex({0, 1, 2, 3}, {{0, 1}, {1, 2}, {1, 3}}));
  const NaiveHierarchy hierarchy = naive_hierarchy(graph, reference_pairs(graph));
  EXPECT_EQ(hierarchy.version_below(1.0, graph), 0u);
  EXPECT_EQ(hierarchy.version_below(1.5, graph), 1u);
  EXPECT_EQ(arcs_of(hierarchy.versions[1]), (Arcs{{0, 3}}));
}

bool is_extremal(const VertexPair& pair) { return pair.type == PairType::kOrd0 || pair.type == PairType::kRel1; }

// Denoising in any order gives one graph, and removes only short extremal pairs from the diagram.
void check_denoise(const ReebGraph& graph, double threshold, std::uint64_t& removed_in_all) {
  SCOPED_TRACE(describe(graph));
  const Denoised denoised = naive_denoise(graph, threshold);
  denoised.graph.validate();
  for (std::uint64_t order = 1; order < 4; ++order)
    ASSERT_EQ(naive_denoise(graph, threshold, order).graph, denoised.graph);
  const auto before = vertex_pairs(graph, reference_pairs(graph));
  const auto after = vertex_pairs(denoised.graph, reference_pairs(denoised.graph));
  std::vector<VertexPair> removed, added;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(removed));
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::back_inserter(added));
  ASSERT_TRUE(added.empty());
  ASSERT_EQ(removed.size(), denoised.removed_pairs);
  for (const VertexPair& pair : removed) ASSERT_TRUE(is_extremal(pair));
  removed_in_all += removed.size();
}

TEST(NaiveDenoise, TakesShortExtremalPairsInAnyOrder) {
  const std::uint64_t seed = base_seed();
  std::uint64_t removed = 0;
  for (std::uint64_t i = 0; i < case_count(1500) && !HasFatalFailure(); ++i) {
    Random random(seed + i);
    check_denoise(random_graph(seed + i), random.unit() * 12, removed);
  }
  EXPECT_GT(removed, 0u);
}

TEST(NaiveDenoise, LeavesALeafOfExactlyTheThreshold) {
  const ReebGraph graph = reference_reeb(make_complex({0, 1, 2, 3}, {{0, 1}, {1, 2}, {1, 3}}));
  EXPECT_EQ(naive_denoise(graph, 1.0).removed_pairs, 0u);
  EXPECT_EQ(naive_denoise(graph, 1.5).removed_pairs, 1u);
  EXPECT_EQ(arcs_of(naive_denoise(graph, 1.5).graph), (Arcs{{0, 3}}));
}

}  // namespace
}  // namespace reeb::test
