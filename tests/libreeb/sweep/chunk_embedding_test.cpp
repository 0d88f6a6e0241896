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

#include "libreeb/base/value_range.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

// Few arcs and indices: many vertices in each bucket, which takes slots and wide sums. Many: most have one.
void compare(ChunkEmbedding& embedding, Random& random) {
  const std::size_t vertices = random.below(400), arcs = random.chance(50) ? random.below(4) : random.below(200);
  // All values 0, in buckets so small that none ends at a double: each vertex seems to begin another one.
  const bool tiny = random.chance(10);
  // Values of some arcs are so far from the others that their indices do not fit in 32 bits.
  const double far = !tiny && random.chance(10) ? 0x1p40 : 0;
  const int exponent = tiny ? -1080 : static_cast<int>(random.below(8)) - 3;
  Chunk chunk;
  chunk.ids.resize(vertices);
  if (random.chance(90)) chunk.positions.resize(vertices);
  const bool some_are_far = random.chance(20);
  for (Point& point : chunk.positions)
    for (double& x : point) x = std::ldexp(random.unit() - 0.5, some_are_far && random.chance(1) ? 60 : 8);
  std::vector<double> values(vertices);
  IdVector<LocalVertex, SweepArc> arc_of;
  for (double& value : values) {
    const SweepArc arc =
        arcs == 0 || random.chance(20) ? SweepArc::none() : SweepArc(static_cast<std::uint32_t>(random.below(arcs)));
    arc_of.add(arc);
    if (!tiny) value = std::ldexp(random.unit() - 0.5, static_cast<int>(random.below(2)) + 4);
    if (arc != SweepArc::none() && arc.value() % 2 == 1) value += far;
  }
  std::vector<std::uint32_t> order(vertices);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t v) { return values[v]; });
  const SweptChunk swept{chunk, values, order, nullptr};

  SweepGraph graph;
  graph.buckets.start(exponent);
  for (std::uint32_t a = 0; a < arcs; ++a) {
    ValueRange range;
    for (std::uint32_t v = 0; v < vertices; ++v)
      if (arc_of[LocalVertex(v)] == SweepArc(a)) range.add(values[v]);
    if (range.min > range.max) range = {0, 0};
    SweepGraph::Node lo, hi;
    lo.key.value = range.min;
    hi.key.value = range.max;
    const SweepNode lower = graph.nodes.add(lo), upper = graph.nodes.add(hi);
    graph.arcs.add({lower, upper, FragmentArc::none(), false});
    graph.arc_buckets.add({});
  }
  embedding.run(graph, swept, arc_of, exponent);

  std::map<std::pair<std::uint32_t, std::int64_t>, BucketSum> expected;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const SweepArc arc = arc_of[LocalVertex(v)];
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
  EXPECT_EQ(graph.buckets.used(), expected.size());
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
