#include "ooc/stored_graph/segment_store.h"
#include "ooc/stored_graph/load_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "libreeb/base/error.h"
#include "libreeb/graph/packed_buckets.h"
#include "ooc/sorting/column_codec.h"
#include "tests/support/scratch.h"

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
  const io::TempDir temp(scratch.path());
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
    EXPECT_TRUE(read_graph(store, {.positions = false}).graph.positions.empty());
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
  expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
    SegmentStore store(temp, budget, {.allowance_bytes = 0, .background = GetParam()});
    add(store, pieces);
    store.finish();
  });
}

INSTANTIATE_TEST_SUITE_P(Background, Segments, testing::Bool());

TEST(SegmentStore, AGraphThatDoesNotFitIsRefusedByItsSize) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(2 << 20);
  SegmentStore store(temp, budget, {.allowance_bytes = 512 << 10, .background = false});
  add(store, random_pieces(100'000, 1));
  store.finish();
  EXPECT_THROW(read_graph(store), Error);
}

TEST(SegmentStore, AnArcThatEndsNowhereIsSeen) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  SegmentStore store(temp, budget);
  store.add_nodes(std::vector<SettledNode>{{{1.0, VertexId(0)}, {}}});
  store.add_arcs({std::vector<ArcKeys>{{{1.0, VertexId(0)}, {2.0, VertexId(1)}}}});
  store.finish();
  EXPECT_THROW(read_graph(store), std::logic_error);
}

// Arcs in the order of adding: calls with an embedding, some of a larger exponent than those before.
struct EmbeddedArcs {
  static constexpr int kExponents = 6, kLast = 2;  // -3 .. 2
  struct Call {
    std::vector<ArcKeys> arcs;
    std::vector<std::uint32_t> counts;
    std::vector<Bucket> buckets;
    int exponent = 0;
  };
  std::vector<Call> calls;
};

// Values are small integers, so that means are exact and equal keys must keep their order.
EmbeddedArcs random_embedded_arcs(const Pieces& pieces, std::uint64_t seed, std::size_t most_buckets) {
  std::mt19937_64 random(seed);
  EmbeddedArcs all;
  for (std::size_t first = 0; first < pieces.arcs.size();) {
    EmbeddedArcs::Call call;
    call.exponent = EmbeddedArcs::kLast - EmbeddedArcs::kExponents + 1 +
                    static_cast<int>(first * EmbeddedArcs::kExponents / pieces.arcs.size());
    const std::size_t last = std::min(pieces.arcs.size(), first + 1 + random() % 500);
    for (; first < last; ++first) {
      call.arcs.push_back(pieces.arcs[first]);
      call.counts.push_back(
          static_cast<std::uint32_t>(random() % 3 == 0 ? random() % (most_buckets + 1) : random() % 3));
      std::int64_t index = -static_cast<std::int64_t>(random() % 50);
      for (std::uint32_t i = 0; i < call.counts.back(); ++i) {
        index += 1 + static_cast<std::int64_t>(random() % 3);
        const auto coordinate = [&] { return static_cast<double>(random() % 1000); };
        call.buckets.push_back({index, 1 + random() % 9, {coordinate(), coordinate(), coordinate()}});
      }
    }
    all.calls.push_back(std::move(call));
  }
  return all;
}

struct EmbeddedArc {
  ArcKeys keys;
  std::vector<Bucket> buckets;
};

// The expected arcs: by a stable sort in memory, coarsened one arc at a time.
std::vector<EmbeddedArc> expected_arcs(const EmbeddedArcs& all) {
  std::vector<EmbeddedArc> arcs;
  for (const auto& call : all.calls) {
    auto next = call.buckets.begin();
    for (std::size_t i = 0; i < call.arcs.size(); next += call.counts[i++]) {
      EmbeddedArc arc{call.arcs[i], {next, next + call.counts[i]}};
      coarsen(arc.buckets, 0, static_cast<unsigned>(EmbeddedArcs::kLast - call.exponent));
      arcs.push_back(std::move(arc));
    }
  }
  std::stable_sort(arcs.begin(), arcs.end(), [](const auto& a, const auto& b) { return a.keys < b.keys; });
  return arcs;
}

void add(SegmentStore& store, const EmbeddedArcs& all, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const auto& call = all.calls[i];
    ArcLists lists;
    auto next = call.buckets.begin();
    for (const std::uint32_t count : call.counts) {
      lists.add(std::span(next, count));
      next += count;
    }
    store.add_arcs({call.arcs, lists.view(), call.exponent});
  }
}

void expect_arcs(SegmentStore& store, const std::vector<EmbeddedArc>& expected, std::size_t limit) {
  store.rewind_arcs();
  std::size_t next = 0;
  for (ArcPiece piece; store.read_arcs(piece, limit, EmbeddedArcs::kLast);) {
    ASSERT_LE(piece.arcs.size(), limit);
    for (std::size_t i = 0; i < piece.arcs.size(); ++i, ++next) {
      ASSERT_LT(next, expected.size());
      ASSERT_EQ(piece.arcs[i], expected[next].keys) << "arc " << next;
      std::vector<Bucket> own;
      piece.lists.view().unpack(i, own);
      ASSERT_EQ(own, expected[next].buckets) << "arc " << next;
    }
  }
  EXPECT_EQ(next, expected.size());
}

TEST_P(Segments, BucketsTravelWithTheirArcs) {
  const Pieces pieces = random_pieces(20'000, 17);
  struct Case {
    std::uint64_t allowance, budget;
    std::size_t most_buckets;
    bool must_spill;
  };
  // The last but one merges in many passes; the last has payloads larger than the allowance.
  for (const Case& c : {Case{48 << 20, 96 << 20, 20, false}, Case{1 << 20, 64 << 20, 20, true},
                        Case{0, 2 << 20, 20, true}, Case{0, 64 << 20, 4000, true}}) {
    SCOPED_TRACE(testing::Message() << "allowance " << c.allowance << ", up to " << c.most_buckets << " buckets");
    const Scratch scratch;
    const io::TempDir temp(scratch.path());
    MemoryBudget budget(c.budget);
    Pieces some = pieces;
    if (c.most_buckets > 100) some.arcs.resize(900);
    const EmbeddedArcs all = random_embedded_arcs(some, 5, c.most_buckets);
    const auto expected = expected_arcs(all);
    {
      SegmentStore store(temp, budget, {.allowance_bytes = c.allowance, .background = GetParam()});
      add(store, all, 0, all.calls.size());
      store.finish();
      EXPECT_EQ(store.spilled_bytes() > 0, c.must_spill);
      expect_arcs(store, expected, 1000);
      expect_arcs(store, expected, 3);
    }
    EXPECT_EQ(budget.used_bytes(), 0u);
  }
}

TEST_P(Segments, AGraphHasTheBucketsOfItsArcs) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(64 << 20);
  const Pieces pieces = random_pieces(9'000, 23);
  const EmbeddedArcs all = random_embedded_arcs(pieces, 6, 10);
  const auto expected = expected_arcs(all);
  SegmentStore store(temp, budget, {.allowance_bytes = 0, .background = GetParam()});
  store.add_nodes(pieces.nodes);
  add(store, all, 0, all.calls.size());
  store.finish();
  const std::uint64_t before = budget.used_bytes();
  const LoadedGraph loaded = read_graph(store, {.bucket_exponent = EmbeddedArcs::kLast});
  ASSERT_EQ(loaded.graph.arc_count(), expected.size());
  ASSERT_EQ(loaded.buckets.size(), expected.size());
  std::uint64_t list_bytes = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    std::vector<Bucket> own;
    ASSERT_TRUE(unpack_buckets(loaded.buckets.of(i), own));
    ASSERT_EQ(own, expected[i].buckets);
    list_bytes += loaded.buckets.of(i).size();
  }
  EXPECT_GE(budget.used_bytes() - before, list_bytes + expected.size() * (2 * sizeof(NodeId) + 8));
  EXPECT_EQ(read_graph(store).buckets.size(), 0u);
}

TEST_P(Segments, ACopyHasTheSameArcsAndBuckets) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(64 << 20);
  const Pieces pieces = random_pieces(9'000, 31);
  const EmbeddedArcs all = random_embedded_arcs(pieces, 8, 10);
  const auto expected = expected_arcs(all);
  const SegmentOptions options{.allowance_bytes = 0, .background = GetParam()};
  SegmentStore store(temp, budget, options), copy(temp, budget, options), plain(temp, budget, options);
  store.add_nodes(pieces.nodes);
  add(store, all, 0, all.calls.size());
  store.finish();
  copy_graph(store, copy, EmbeddedArcs::kLast, [] {});
  copy.finish();
  EXPECT_EQ(copy.node_count(), store.node_count());
  expect_arcs(copy, expected, 1000);
  std::uint64_t buckets = 0;
  for (const EmbeddedArc& arc : expected) buckets += arc.buckets.size();
  EXPECT_EQ(copy.bucket_count(), buckets);
  copy_graph(store, plain, {}, [] {});
  plain.finish();
  EXPECT_EQ(plain.arc_count(), store.arc_count());
  EXPECT_EQ(plain.payload_bytes(), 0u);
}

TEST(ArcPayload, AListIsUnpackedOnlyToCoarsenIt) {
  const std::vector<Bucket> buckets{{-3, 2, {1, 2, 3}}, {4, 1, {0.1, 0.2, 0.3}}, {5, 7, {4, 5, 6}}};
  std::vector<std::byte> list, payload;
  pack_buckets(buckets, list);
  encode_list(list, -2, payload);
  CoarsenedList coarsened;
  const auto same = packed_list(payload, -2, coarsened);
  ASSERT_TRUE(same.has_value());
  EXPECT_TRUE(std::ranges::equal(*same, list));
  EXPECT_EQ(same->data() + same->size(), payload.data() + payload.size());
  const auto coarser = packed_list(payload, 0, coarsened);
  ASSERT_TRUE(coarser.has_value());
  std::vector<Bucket> expected = buckets, own;
  coarsen(expected, 0, 2);
  ASSERT_TRUE(unpack_buckets(*coarser, own));
  EXPECT_EQ(own, expected);
  EXPECT_FALSE(packed_list(payload, -3, coarsened).has_value());
  EXPECT_TRUE(packed_list({}, 5, coarsened)->empty());
}

TEST_P(Segments, AnotherProcessGoesOnWithTheBuckets) {
  const Pieces pieces = random_pieces(20'000, 29);
  const EmbeddedArcs all = random_embedded_arcs(pieces, 7, 12);
  const auto expected = expected_arcs(all);
  for (const std::uint64_t allowance : {std::uint64_t{0}, std::uint64_t{8} << 20}) {
    const Scratch scratch;
    const io::TempDir temp(scratch.path());
    MemoryBudget budget;
    const SegmentOptions options{
        .allowance_bytes = allowance, .background = GetParam(), .files = scratch.path() + "/segments"};
    StateBytes state;
    const std::size_t half = all.calls.size() / 2;
    {
      SegmentStore store(temp, budget, options);
      add(store, all, 0, half);
      store.save(state);
      add(store, all, half, half + 20);  // is discarded
    }
    SegmentStore store(temp, budget, options);
    store.restore(state);
    add(store, all, half, all.calls.size());
    store.finish();
    expect_arcs(store, expected, 777);
  }
}

TEST(SegmentStore, BucketsOfALargerExponentThanTheLastAreSeen) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  SegmentStore store(temp, budget);
  ArcLists lists;
  lists.add(std::array{Bucket{0, 1, {}}});
  store.add_arcs({std::array{ArcKeys{{1.0, VertexId(0)}, {2.0, VertexId(1)}}}, lists.view(), 3});
  store.finish();
  ArcPiece piece;
  EXPECT_THROW(store.read_arcs(piece, 1, 2), std::logic_error);
}

// Whatever the bytes, a decoder returns a result or refuses; it never reads beyond its arrays.
TEST(SegmentCodecs, RefuseDamagedBlocks) {
  Pieces pieces = random_pieces(300, 8);
  std::sort(pieces.arcs.begin(), pieces.arcs.end());
  std::vector<std::byte> packed;
  std::vector<StoredArc> arcs;
  std::vector<std::byte> pool;
  for (unsigned i = 0; i < 7; ++i) pool.push_back(static_cast<std::byte>(i));
  for (std::size_t i = 0; i < pieces.arcs.size(); ++i)
    arcs.push_back({pieces.arcs[i], {static_cast<std::uint32_t>(i % 5), static_cast<std::uint32_t>(i % 3)}});
  ArcCodec::encode(arcs, pool, packed);
  std::vector<StoredArc> back(arcs.size());
  std::vector<std::byte> own;
  ASSERT_TRUE(ArcCodec::decode(packed, back, own));
  EXPECT_EQ(own.size(), arcs.size());  // 0, 1, 2 bytes in turn
  const auto bytes = [](std::span<const std::byte> all, const StoredArc& arc) {
    const auto payload = all.subspan(arc.payload.first, arc.payload.size);
    return std::vector(payload.begin(), payload.end());
  };
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    EXPECT_EQ(back[i].keys, arcs[i].keys);
    EXPECT_EQ(bytes(own, back[i]), bytes(pool, arcs[i]));
  }
  for (std::size_t size = 0; size < packed.size(); size += 37)
    EXPECT_FALSE(ArcCodec::decode(std::span(packed).first(size), back, own));
  packed.push_back({});
  EXPECT_FALSE(ArcCodec::decode(packed, back, own)) << "more bytes than payloads";
  packed.pop_back();
  back.pop_back();
  EXPECT_FALSE(ArcCodec::decode(packed, back, own));
}

// The sum of the sizes is right only because it wraps.
TEST(SegmentCodecs, RefuseForgedSizesOfPayloads) {
  const std::vector<ArcKeys> keys(2);
  for (const std::uint64_t size : {~std::uint64_t{0}, std::uint64_t{1} << 32, std::uint64_t{1} << 63}) {
    ColumnEncoder columns;
    for (int column = 0; column < 4; ++column) columns.add(keys.size(), [](std::size_t) { return std::uint64_t{0}; });
    columns.add(keys.size(), [&](std::size_t i) { return i == 0 ? size : 3 - size; });
    std::vector<std::byte> packed;
    columns.pack(packed);
    packed.resize(packed.size() + 3);
    std::vector<StoredArc> arcs(keys.size());
    std::vector<std::byte> pool;
    EXPECT_FALSE(ArcCodec::decode(packed, arcs, pool)) << size;
  }
}

}  // namespace
}  // namespace reeb::ooc
