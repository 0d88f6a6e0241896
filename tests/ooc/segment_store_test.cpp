#include "ooc/segment_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "libreeb/base/error.h"
#include "tests/ooc/scratch.h"

namespace reeb::ooc {
namespace {

struct Pieces {
  std::vector<SettledNode> nodes;
  std::vector<ArcKeys> arcs;  // parallel ones among them
};

Pieces random_pieces(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Pieces pieces;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = (static_cast<double>(random() % 2000) - 1000.0) / 7;  // with ties
    pieces.nodes.push_back({{value, VertexId(i * 3)}, {value, -value + 0.0, 0.1 * static_cast<double>(i)}});
  }
  std::shuffle(pieces.nodes.begin(), pieces.nodes.end(), random);
  for (std::size_t i = 0; count > 1 && i < count * 3 / 2; ++i) {
    const SweepKey a = pieces.nodes[random() % count].key, b = pieces.nodes[random() % count].key;
    if (a == b) continue;
    pieces.arcs.push_back({std::min(a, b), std::max(a, b)});
    if (i % 10 == 0) pieces.arcs.push_back(pieces.arcs.back());
  }
  return pieces;
}

void add(SegmentStore& store, const Pieces& pieces) {
  const std::size_t step = 777;
  for (std::size_t i = 0; i < pieces.nodes.size(); i += step)
    store.add_nodes(std::span(pieces.nodes).subspan(i, std::min(step, pieces.nodes.size() - i)));
  for (std::size_t i = 0; i < pieces.arcs.size(); i += step)
    store.add_arcs({std::span(pieces.arcs).subspan(i, std::min(step, pieces.arcs.size() - i))});
}

class Segments : public testing::TestWithParam<bool> {};

void compare(std::size_t count, SegmentOptions options, bool must_spill) {
  SCOPED_TRACE(testing::Message() << count << " nodes, allowance " << options.allowance_bytes);
  const Scratch scratch;
  const TempDir temp(scratch.path());
  MemoryBudget budget(32 << 20);
  Pieces pieces = random_pieces(count, count);
  {
    SegmentStore store(temp, budget, options);
    add(store, pieces);
    store.finish();
    EXPECT_EQ(store.spilled_bytes() > 0, must_spill);
    const LoadedGraph loaded = read_graph(store);
    EXPECT_NO_THROW(loaded.graph.validate());
    std::sort(pieces.nodes.begin(), pieces.nodes.end(), NodeLess());
    std::sort(pieces.arcs.begin(), pieces.arcs.end());
    ASSERT_EQ(loaded.graph.node_count(), pieces.nodes.size());
    ASSERT_EQ(loaded.graph.arc_count(), pieces.arcs.size());
    for (std::size_t i = 0; i < pieces.nodes.size(); ++i) {
      ASSERT_EQ(loaded.graph.nodes[i], pieces.nodes[i].key);
      ASSERT_EQ(loaded.graph.positions[i], pieces.nodes[i].position);
    }
    for (std::size_t i = 0; i < pieces.arcs.size(); ++i) {
      ASSERT_EQ(loaded.graph.nodes[loaded.graph.lo[i].value()], pieces.arcs[i].lo);
      ASSERT_EQ(loaded.graph.nodes[loaded.graph.hi[i].value()], pieces.arcs[i].hi);
    }
    EXPECT_TRUE(read_graph(store, false).graph.positions.empty());
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
  EXPECT_TRUE(scratch.empty());
}

TEST_P(Segments, GiveBackAllInCanonicalOrder) {
  compare(0, {.allowance_bytes = 0, .background = GetParam()}, false);
  compare(1, {.allowance_bytes = 0, .background = GetParam()}, false);
  compare(1000, {.allowance_bytes = 8 << 20, .background = GetParam()}, false);
  compare(20'000, {.allowance_bytes = 0, .background = GetParam()}, true);
  compare(100'000, {.allowance_bytes = 1 << 20, .background = GetParam()}, true);
}

TEST_P(Segments, EachFailingWriteIsReported) {
  const Pieces pieces = random_pieces(12'000, 4);
  expect_failing_writes_are_reported([&](const TempDir& temp, MemoryBudget& budget) {
    SegmentStore store(temp, budget, {.allowance_bytes = 0, .background = GetParam()});
    add(store, pieces);
    store.finish();
  });
}

INSTANTIATE_TEST_SUITE_P(Background, Segments, testing::Bool());

TEST(SegmentStore, AGraphThatDoesNotFitIsRefusedByItsSize) {
  const Scratch scratch;
  const TempDir temp(scratch.path());
  MemoryBudget budget(2 << 20);
  SegmentStore store(temp, budget, {.allowance_bytes = 512 << 10, .background = false});
  add(store, random_pieces(100'000, 1));
  store.finish();
  EXPECT_THROW(read_graph(store), Error);
}

TEST(SegmentStore, AnArcThatEndsNowhereIsSeen) {
  const Scratch scratch;
  const TempDir temp(scratch.path());
  MemoryBudget budget;
  SegmentStore store(temp, budget);
  store.add_nodes(std::vector<SettledNode>{{{1.0, VertexId(0)}, {}}});
  store.add_arcs({std::vector<ArcKeys>{{{1.0, VertexId(0)}, {2.0, VertexId(1)}}}});
  store.finish();
  EXPECT_THROW(read_graph(store), std::logic_error);
}

// Whatever the bytes, a decoder answers or refuses; it never leaves its arrays.
TEST(SegmentCodecs, RefuseDamagedBlocks) {
  Pieces pieces = random_pieces(300, 8);
  std::sort(pieces.arcs.begin(), pieces.arcs.end());
  std::vector<std::byte> packed;
  ArcCodec::encode(pieces.arcs, packed);
  std::vector<ArcKeys> back(pieces.arcs.size());
  ASSERT_TRUE(ArcCodec::decode(packed, back));
  EXPECT_EQ(back, pieces.arcs);
  for (std::size_t size = 0; size < packed.size(); size += 37)
    EXPECT_FALSE(ArcCodec::decode(std::vector(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size)), back));
  back.pop_back();
  EXPECT_FALSE(ArcCodec::decode(packed, back));
}

}  // namespace
}  // namespace reeb::ooc
