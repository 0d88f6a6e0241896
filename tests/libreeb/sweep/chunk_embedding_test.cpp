// The buckets of random chunks against maps from arc and index to the vertices.
#include "libreeb/sweep/chunk_embedding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

// Few arcs and indices: many vertices in each bucket, which takes wide sums. Many: most have one.
void compare(ChunkEmbedding& embedding, Random& random) {
  const std::size_t vertices = random.below(400), arcs = random.chance(50) ? random.below(4) : random.below(200);
  // All values 0, in buckets so small that none ends at a double: each vertex seems to begin another one.
  const bool tiny = random.chance(10);
  const int exponent = tiny ? -1080 : static_cast<int>(random.below(8)) - 3;
  Chunk chunk;
  chunk.ids.resize(vertices);
  if (random.chance(90)) chunk.positions.resize(vertices);
  for (Point& point : chunk.positions)
    for (double& x : point) x = std::ldexp(random.unit() - 0.5, random.chance(1) ? 60 : 8);
  std::vector<double> values(vertices);
  if (!tiny)
    for (double& value : values) value = std::ldexp(random.unit() - 0.5, static_cast<int>(random.below(2)) + 4);
  std::vector<std::uint32_t> order(vertices);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t v) { return values[v]; });
  const SweptChunk swept{chunk, values, order, nullptr};

  SweepGraph graph;
  graph.buckets.start(exponent);
  for (std::size_t a = 0; a < arcs; ++a) {
    graph.arcs.add({});
    graph.arc_buckets.add({});
  }
  IdVector<VertexRank, SweepArc> arc_of;
  for (std::size_t v = 0; v < vertices; ++v)
    arc_of.add(arcs == 0 || random.chance(20) ? SweepArc::none()
                                              : SweepArc(static_cast<std::uint32_t>(random.below(arcs))));
  embedding.run(graph, swept, arc_of, exponent);

  std::map<std::pair<std::uint32_t, std::int64_t>, BucketSum> expected;
  std::vector<std::uint32_t> rank(vertices);
  for (std::uint32_t r = 0; r < vertices; ++r) rank[order[r]] = r;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const SweepArc arc = arc_of[VertexRank(rank[v])];
    if (arc == SweepArc::none()) continue;
    const auto index = static_cast<std::int64_t>(std::floor(std::ldexp(values[v], -exponent)));
    const auto bucket = expected.try_emplace({arc.value(), index}, BucketSum{.index = index}).first;
    bucket->second.add(chunk.position(LocalVertex(v)));
  }
  std::size_t count = 0;
  for (SweepArc a; a < graph.arc_buckets.end_id(); ++a) {
    std::int64_t last = std::numeric_limits<std::int64_t>::min();
    graph.buckets.visit(graph.arc_buckets[a], [&](const BucketSum& bucket) {
      const auto at = expected.find({a.value(), bucket.index});
      ASSERT_NE(at, expected.end());
      EXPECT_TRUE(bucket == at->second) << "arc " << a.value() << ", bucket " << bucket.index;
      EXPECT_LT(last, bucket.index);
      last = bucket.index;
      ++count;
    });
  }
  EXPECT_EQ(count, expected.size());
}

TEST(ChunkEmbedding, HasEachVertexInTheBucketOfItsArcAndValue) {
  const std::uint64_t seed = base_seed(), cases = case_count(1000);
  ChunkEmbedding embedding;  // used again, as a sweep does
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    Random random(seed + i);
    compare(embedding, random);
  }
}

}  // namespace
}  // namespace reeb::test
