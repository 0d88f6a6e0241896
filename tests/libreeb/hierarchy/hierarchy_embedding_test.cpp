// The embedding during noise removal and cancelling: no vertex is lost, each stays in the bucket of its value, and the
// graphs are the same as without an embedding.
#include <gtest/gtest.h>

#include <ctime>

#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/levels.h"
#include "libreeb/noise/denoise.h"
#include "tests/libreeb/hierarchy/random_buckets.h"

namespace reeb {
namespace {

void expect_same_mass(const test::Mass& a, const test::Mass& b) {
  ASSERT_EQ(a.count, b.count);
  for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(a.sum[axis], b.sum[axis], 1e-6);
}

TEST(Embedding, NoiseRemovalKeepsEveryVertexAndTheResult) {
  std::size_t removed = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    test::EmbeddedGraph made = test::random_embedded_graph(random, 16);
    const double threshold = static_cast<double>(test::below(random, 32));
    const test::Mass before = test::mass_of(made.graph, made.buckets.view());

    const Denoised result = denoise(made.graph, threshold, made.buckets, made.exponent);
    const Denoised plain = denoise(made.graph, threshold);
    ASSERT_EQ(result.graph, plain.graph);
    ASSERT_EQ(result.removed, plain.removed);
    removed += result.removed.size();

    ASSERT_EQ(made.buckets.offsets.size(), result.graph.arc_count() + 1);
    expect_same_mass(test::mass_of(result.graph, made.buckets.view()), before);
    for (std::size_t arc = 0; arc < result.graph.arc_count(); ++arc)
      ASSERT_TRUE(test::well_formed(made.buckets.view().of(arc), result.graph.nodes[result.graph.lo[arc].value()].value,
                                    result.graph.nodes[result.graph.hi[arc].value()].value, made.exponent))
          << "arc " << arc;
  }
  EXPECT_GT(removed, 1000u);
}

void check_every_version(const test::EmbeddedGraph& made, const Hierarchy& h, const ArcBucketsView& buckets) {
  const test::Mass full = test::mass_of(made.graph, made.buckets.view());
  std::uint64_t dropped = 0;
  auto drop = h.dropped.begin();
  for (std::uint32_t version = 0; version <= last_version(h); ++version) {
    SCOPED_TRACE(testing::Message() << "version " << version);
    for (; drop != h.dropped.end() && drop->version == version; ++drop) dropped += drop->count;
    test::Mass mass = test::mass_of_nodes(graph_at(h, made.graph, version));
    for (std::size_t i = 0; i < h.arcs.size(); ++i)
      if (h.arcs[i].born <= version && version < h.arcs[i].died) mass.add(buckets.of(i));
    ASSERT_EQ(mass.count + dropped, full.count);
    if (dropped == 0) expect_same_mass(mass, full);
  }
  ASSERT_EQ(drop, h.dropped.end());
}

class RandomEmbeddings : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomEmbeddings, CancellingKeepsEveryVertexAndTheResult) {
  std::size_t drops = 0, steps = 0, plain_records = 0, records = 0;
  for (std::uint64_t seed = 0; seed < 48000 / GetParam(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const test::EmbeddedGraph made = test::random_embedded_graph(random, GetParam());
    ArcBuckets buckets = made.buckets;
    const Hierarchy h = build_hierarchy(made.graph, buckets, made.exponent);
    const Hierarchy plain = build_hierarchy(made.graph);
    ASSERT_EQ(h.pairs, plain.pairs);
    ASSERT_EQ(h.persistence, plain.persistence);
    for (std::uint32_t version = 0; version <= last_version(h); ++version)
      ASSERT_EQ(graph_at(h, made.graph, version), graph_at(plain, made.graph, version));

    ASSERT_EQ(buckets.offsets.size(), h.arcs.size() + 1);
    for (std::size_t i = 0; i < h.arcs.size(); ++i)
      ASSERT_TRUE(test::well_formed(buckets.view().of(i), made.graph.nodes[h.arcs[i].lo.value()].value,
                                    made.graph.nodes[h.arcs[i].hi.value()].value, made.exponent));
    check_every_version(made, h, buckets.view());
    drops += h.dropped.size();
    steps += h.persistence.size();
    records += h.arcs.size();
    plain_records += plain.arcs.size();
  }
  EXPECT_TRUE(drops > 0 || GetParam() == 6) << "no loop was dropped";
  EXPECT_LT(records, plain_records + 4 * steps);
}
INSTANTIATE_TEST_SUITE_P(Nodes, RandomEmbeddings, testing::Values(6, 12, 24));

// ---- by hand: the value of a vertex is its first coordinate

constexpr int kUnit = 0;  // exponent of buckets of width 1

ReebGraph graph_of(const std::vector<std::pair<std::uint64_t, std::uint64_t>>& arcs) {
  std::vector<ArcKeys> keys;
  for (const auto& [lo, hi] : arcs)
    keys.push_back({{static_cast<double>(lo), VertexId(lo)}, {static_cast<double>(hi), VertexId(hi)}});
  ReebGraph graph = make_graph(std::move(keys), {});
  for (const SweepKey& node : graph.nodes) graph.positions.push_back({node.value, 0, 0});
  return graph;
}

ArcBuckets embedding(const std::vector<std::vector<Bucket>>& of_arcs) {
  ArcBuckets buckets{.offsets = {0}, .buckets = {}};
  for (const auto& own : of_arcs) {
    buckets.buckets.insert(buckets.buckets.end(), own.begin(), own.end());
    buckets.offsets.push_back(buckets.buckets.size());
  }
  return buckets;
}

// Without spreads and rims, which bucket_test.cpp is about.
std::vector<Bucket> of(const ArcBuckets& buckets, std::size_t arc) {
  std::vector<Bucket> own;
  for (const Bucket& bucket : buckets.view().of(arc)) own.push_back({bucket.index, bucket.count, bucket.mean});
  return own;
}

TEST(Embedding, ParallelArcsTakeTimeInProportionToTheirNumber) {
  // One of 100,000 arcs has a vertex. Were each loop a search of all arcs, this would be 10^10 steps.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> arcs(100000, {0, 9});
  arcs.push_back({0, 4});  // and one that ends below
  std::vector<std::vector<Bucket>> of_arcs(arcs.size());
  of_arcs[77] = {{5, 1, {5.5, 0, 0}}};
  ArcBuckets buckets = embedding(of_arcs);
  const ReebGraph graph = graph_of(arcs);
  const std::clock_t start = std::clock();  // processor time: it does not depend on other processes
  const Hierarchy h = build_hierarchy(graph, buckets, kUnit);
  EXPECT_LT(std::clock() - start, 5 * CLOCKS_PER_SEC) << "usually 0.05 s";
  EXPECT_EQ(h.persistence.size(), arcs.size() - 1);
  std::uint64_t vertices = 0;
  for (const Bucket& bucket : buckets.view().of(0)) vertices += bucket.count;
  EXPECT_GE(vertices, 1u) << "the last arc has the vertices of all";
}

TEST(Embedding, ALeafIsLaidBesideItselfAndEndsInsideItsBucket) {
  // Up-fork 4 with the maximum 6 and the arc to 9. Only the arc (0, 9) remains.
  const ReebGraph graph = graph_of({{0, 4}, {4, 6}, {4, 9}});
  const std::vector<std::vector<Bucket>> of_arcs{
      {{1, 2, {1.5, 0, 0}}}, {{4, 1, {4.5, 4, 0}}, {5, 3, {5.5, 4, 0}}}, {{5, 1, {5.5, 0, 0}}, {8, 5, {8.5, 0, 0}}}};
  const std::vector<Bucket> expected{{1, 2, {1.5, 0, 0}},
                                     {4, 2, {4.25, 2, 0}},  // with the fork
                                     {5, 4, {5.5, 3, 0}},
                                     {6, 1, {6, 0, 0}},  // the maximum itself
                                     {8, 5, {8.5, 0, 0}}};
  ArcBuckets denoised = embedding(of_arcs);
  EXPECT_EQ(denoise(graph, 3, denoised, kUnit).graph.arc_count(), 1u);
  EXPECT_EQ(of(denoised, 0), expected);

  ArcBuckets cancelled = embedding(of_arcs);
  const Hierarchy h = build_hierarchy(graph, cancelled, kUnit);
  ASSERT_EQ(h.arcs.front(), (ArcVersion{NodeId(0), NodeId(3), 1, kNeverDies}));
  EXPECT_EQ(of(cancelled, 0), expected);
}

TEST(Embedding, ABucketThatANodeCutsIsDividedInProportion) {
  // The arc of the maximum 6 is zipped past the up-fork 5. It has the values from 4 to 6 of a bucket of width 4, with 8
  // vertices. Half of them count as below 5.
  const ReebGraph graph = graph_of({{0, 4}, {4, 5}, {4, 6}, {5, 9}, {5, 10}});
  ArcBuckets buckets = embedding({{}, {}, {{1, 8, {5, 0, 0}}}, {}, {}});
  const Denoised result = denoise(graph, 3, buckets, 2);
  ASSERT_EQ(result.graph.arc_count(), 3u);
  EXPECT_EQ(of(buckets, 0), (std::vector<Bucket>{{1, 5, {4.8, 0, 0}}}));  // four, and the fork 4
  EXPECT_EQ(of(buckets, 1), (std::vector<Bucket>{{1, 5, {5.2, 0, 0}}}));  // four, and the maximum
  EXPECT_TRUE(of(buckets, 2).empty());
}

TEST(Embedding, AnArcOfALoopIsLaidOnTheOtherWay) {
  const ReebGraph graph = graph_of({{0, 1}, {1, 4}, {1, 4}, {4, 6}});
  ArcBuckets buckets = embedding({{}, {{2, 1, {2.5, 0, 0}}}, {{2, 3, {2.5, 4, 0}}}, {}});
  const Hierarchy h = build_hierarchy(graph, buckets, kUnit);
  EXPECT_TRUE(h.dropped.empty());
  EXPECT_EQ(of(buckets, 0), (std::vector<Bucket>{{1, 1, {1, 0, 0}}, {2, 4, {2.5, 3, 0}}, {4, 1, {4, 0, 0}}}));
}

TEST(Embedding, AnArcOfALoopWithoutAnotherWayIsDropped) {
  // The arc (10, 14) is one side of the loop; the other goes up to 13, down to 12 and up again.
  const ReebGraph graph = graph_of({{0, 10}, {2, 12}, {10, 13}, {10, 14}, {12, 13}, {12, 14}, {13, 30}, {14, 31}});
  const std::vector<Bucket> of_direct{{11, 9, {11.5, 0, 0}}, {12, 1, {12.5, 0, 0}}};
  ArcBuckets buckets = embedding({{}, {}, {}, of_direct, {}, {}, {}, {}});
  const Hierarchy h = build_hierarchy(graph, buckets, kUnit);
  ASSERT_EQ(h.pairs[0], (PersistencePair{NodeId(2), NodeId(5), PairType::kExt1}));
  EXPECT_EQ(h.dropped, (std::vector<DroppedVertices>{{1, 10}}));
}

TEST(Embedding, AnArcThatNothingIsLaidOnKeepsItsRecord) {
  // Cancelling (4, 5) touches only the arcs up from 4.
  const ReebGraph graph = graph_of({{0, 4}, {1, 4}, {4, 5}, {4, 9}});
  ArcBuckets buckets = embedding({{{2, 1, {2.5, 0, 0}}}, {}, {}, {{7, 1, {7.5, 0, 0}}}});
  const Hierarchy h = build_hierarchy(graph, buckets, kUnit);
  const std::vector<ArcVersion> expected{{NodeId(0), NodeId(4), 2, kNeverDies}, {NodeId(0), NodeId(2), 0, 2},
                                         {NodeId(1), NodeId(2), 0, 2},          {NodeId(2), NodeId(4), 1, 2},
                                         {NodeId(2), NodeId(3), 0, 1},          {NodeId(2), NodeId(4), 0, 1}};
  EXPECT_EQ(h.arcs, expected);
  EXPECT_EQ(of(buckets, 5), (std::vector<Bucket>{{7, 1, {7.5, 0, 0}}}));
  EXPECT_EQ(of(buckets, 3), (std::vector<Bucket>{{5, 1, {5, 0, 0}}, {7, 1, {7.5, 0, 0}}}));
}

TEST(Embedding, AnExtremumIsLaidOn8ArcsAtMost) {
  // The maximum 150, next to a path up with forks at 2, 3, ..., 101, all of larger persistence.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> arcs{{0, 1}, {1, 2}, {1, 150}};
  std::vector<std::vector<Bucket>> of_arcs(3);
  for (int i = 2; i < 150; ++i) of_arcs[2].push_back({i, 1, {i + 0.5, 0, 0}});
  for (std::uint64_t fork = 2; fork <= 101; ++fork) {
    arcs.emplace_back(fork, fork == 101 ? 2000 : fork + 1);
    arcs.emplace_back(fork, 1000 + fork);
    if (fork == 101) std::swap(arcs.back(), arcs[arcs.size() - 2]);
  }
  of_arcs.resize(arcs.size());
  test::EmbeddedGraph made{graph_of(arcs), embedding(of_arcs), kUnit};

  ArcBuckets buckets = made.buckets;
  const Hierarchy h = build_hierarchy(made.graph, buckets, kUnit);
  ASSERT_EQ(h.pairs[0].type, PairType::kRel1);
  // Of the vertices 2 to 149, those up to 8 are moved to the arcs that end in 3, ..., 9.
  ASSERT_FALSE(h.dropped.empty());
  EXPECT_EQ(h.dropped.front(), (DroppedVertices{1, 149 - 8 + 1}));
  check_every_version(made, h, buckets.view());
}

}  // namespace
}  // namespace reeb
