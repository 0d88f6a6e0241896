// Packed lists of buckets: packing loses nothing. Lists that are replaced repeatedly, in any order, stay equal to a
// plain vector of vectors, in memory that does not grow with the number of changes.
#include "libreeb/graph/packed_lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "libreeb/graph/packed_buckets.h"
#include "tests/libreeb/hierarchy/random_graphs.h"

namespace reeb {
namespace {

std::vector<Bucket> random_list(test::Random& random, std::uint32_t most) {
  std::vector<Bucket> list;
  std::int64_t index = static_cast<std::int64_t>(test::below(random, 2000)) - 1000;
  for (std::uint32_t i = test::below(random, most + 1); i > 0; --i) {
    index += 1 + test::below(random, 3);
    const double x = static_cast<double>(test::below(random, 1000));
    list.push_back({index, 1 + test::below(random, 300), {x / (test::below(random, 2) == 0 ? 1 : 3), -x, 0.5}});
    if (list.back().count == 1) continue;
    list.back().spread = static_cast<float>(x);
    list.back().rim = {static_cast<float>(x), 1, -2};
  }
  return list;
}

std::vector<Bucket> unpacked(std::span<const std::byte> packed) {
  std::vector<Bucket> list;
  EXPECT_TRUE(unpack_buckets(packed, list));
  EXPECT_EQ(list.size(), packed_count(packed));
  return list;
}

TEST(PackedBuckets, ExtremeNumbersComeBack) {
  constexpr double kHuge = std::numeric_limits<double>::max(), kTiny = std::numeric_limits<double>::denorm_min();
  const std::vector<Bucket> list{
      {std::numeric_limits<std::int64_t>::min(), 1, {kHuge, -kHuge, kTiny}},
      {-1, std::uint64_t{1} << 62, {0.1, 0.2, 0.3}, 1e30f, {-1e30f, 1e-30f, 0.5f}},
      {0, 1, {1.5, -0.25, 1e30f}},
      {std::numeric_limits<std::int64_t>::max(), 8191, {0, 0, 0}},
  };
  std::vector<std::byte> packed;
  pack_buckets(list, packed);
  EXPECT_EQ(unpacked(packed), list);
  EXPECT_EQ(packed_end(packed, kDown), list.front());
  EXPECT_EQ(packed_end(packed, kUp), list.back());
}

// A bucket of several vertices comes before one of a single vertex, and the other way round.
TEST(PackedBuckets, TheEndsAreFoundInTheWholeList) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    test::Random random(seed);
    const std::vector<Bucket> list = random_list(random, 5);
    if (list.empty()) continue;
    std::vector<std::byte> packed;
    pack_buckets(list, packed);
    ASSERT_EQ(packed_end(packed, kDown), list.front()) << "seed " << seed;
    ASSERT_EQ(packed_end(packed, kUp), list.back()) << "seed " << seed;
  }
}

// Without a look at what is left, this would take years.
TEST(PackedBuckets, TheEndOfAListThatIsCutIsFoundAtOnce) {
  std::array<std::byte, most_packed_bytes(1)> bytes;
  BucketPacker packer(std::uint64_t{1} << 60, bytes.data());
  packer.add({5, 1, {0.5, 1, 2}});
  packed_end({bytes.data(), packer.end()}, kUp);
}

TEST(PackedBuckets, SingleVerticesInSinglePrecisionTakeFourteenBytes) {
  std::vector<std::byte> packed;
  pack_buckets(std::vector<Bucket>{{5, 1, {0.5, 1, 2}}, {6, 1, {0.1f, 1, 2}}}, packed);
  EXPECT_EQ(packed.size(), 1 + 2 * 14u);
  packed.clear();
  pack_buckets({}, packed);
  EXPECT_TRUE(packed.empty());
}

TEST(PackedBuckets, EveryPrefixIsRefused) {
  test::Random random(3);
  std::vector<std::byte> packed;
  while (packed.size() < 200) {
    packed.clear();
    pack_buckets(random_list(random, 20), packed);
  }
  for (std::size_t size = 1; size < packed.size(); ++size) {
    const std::vector<std::byte> cut(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
    std::vector<Bucket> list;
    EXPECT_FALSE(unpack_buckets(cut, list)) << size << " bytes";
  }
}

// Lists of each kind come one after the other, and none of those before clear() shows.
TEST(ArcLists, GiveBackWhatWasAdded) {
  test::Random random(1);
  ArcLists lists;
  EXPECT_TRUE(lists.view().empty());
  for (std::uint32_t round = 0; round < 200; ++round) {
    lists.clear();
    std::vector<std::vector<Bucket>> expected(test::below(random, 40));
    for (std::vector<Bucket>& list : expected) {
      list = random_list(random, round % 7);
      if (test::below(random, 2) == 0) {
        lists.add(list);
        continue;
      }
      std::vector<std::byte> packed;
      pack_buckets(list, packed);
      lists.add_packed(packed);
    }
    const ArcListsView view = lists.view();
    ASSERT_EQ(view.ends.size(), expected.size());
    ASSERT_EQ(view.bytes.size(), expected.empty() ? 0 : view.ends.back());
    ASSERT_GE(lists.memory_bytes(), view.bytes.size() + view.ends.size_bytes());
    for (std::size_t arc = 0; arc < expected.size(); ++arc) {
      ASSERT_EQ(unpacked(view.of(arc)), expected[arc]) << "round " << round << ", arc " << arc;
      std::vector<Bucket> own{{7, 1, {}}};
      view.unpack(arc, own);
      ASSERT_TRUE(std::ranges::equal(std::span(own).subspan(1), expected[arc]));
    }
  }
}

// Most changes hit the same few lists, as in a hierarchy.
TEST(PackedLists, ListsStayWhatTheyAreWhileOthersAreReplaced) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    std::vector<std::vector<Bucket>> plain;
    PackedLists lists;
    for (std::uint32_t arc = 0; arc < 5000; ++arc) {
      plain.push_back(random_list(random, arc % 1000 == 7 ? 6000 : arc % 3 == 0 ? 0 : 8));
      lists.add(plain.back());
    }
    std::vector<std::byte> packed;
    for (int step = 0; step < 20'000; ++step) {
      const std::uint32_t some = test::below(random, 4) == 0 ? 5000 : 50;
      std::vector<std::uint32_t> arcs;
      for (std::uint32_t i = 1 + test::below(random, 5); i > 0; --i) arcs.push_back(test::below(random, some));
      std::ranges::sort(arcs);
      arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
      std::vector<std::span<const std::byte>> before;
      std::vector<std::vector<Bucket>> expected;
      for (const std::uint32_t arc : arcs) {
        before.push_back(lists.of(arc));
        expected.push_back(plain[arc]);
        plain[arc] = random_list(random, arc % 1000 == 7 ? 6000 : 8);
        packed.clear();
        pack_buckets(plain[arc], packed);
        lists.replace(arc, packed);
      }
      for (std::size_t i = 0; i < arcs.size(); ++i) ASSERT_EQ(unpacked(before[i]), expected[i]) << "until collect()";
      lists.collect();
    }
    std::uint64_t bytes = 0;
    for (std::uint32_t arc = 0; arc < 5000; ++arc) {
      ASSERT_EQ(unpacked(lists.of(arc)), plain[arc]) << "arc " << arc;
      bytes += lists.of(arc).size() + 6;
    }
    constexpr std::uint64_t kChunks = 5 * (64 << 10), kTables = 2 * 8 * 5000;
    EXPECT_LE(lists.memory_bytes(), bytes + 3 * bytes / 8 + kChunks + kTables);
  }
}

// So that another thread can read them: neither a list that is replaced moves, nor one that stays.
TEST(PackedLists, NothingMovesWhileListsAreHeld) {
  test::Random random(5);
  std::vector<std::vector<Bucket>> plain;
  PackedLists lists;
  for (std::uint32_t arc = 0; arc < 3000; ++arc) lists.add(plain.emplace_back(random_list(random, 40)));
  std::vector<std::byte> packed;
  for (int turn = 0; turn < 20; ++turn) {
    std::vector<std::span<const std::byte>> before;
    for (std::uint32_t arc = 0; arc < 3000; ++arc) before.push_back(lists.of(arc));
    const std::vector<std::vector<Bucket>> expected = plain;
    constexpr std::uint32_t kReplaced = 1000;
    lists.hold(kReplaced);
    EXPECT_FALSE(lists.holds_much());
    for (std::uint32_t i = 0; i < kReplaced; ++i) {
      const std::uint32_t arc = 1000 + test::below(random, 2000);
      plain[arc] = random_list(random, 400);
      packed.clear();
      pack_buckets(plain[arc], packed);
      lists.replace(arc, packed);
      lists.collect();
    }
    EXPECT_TRUE(lists.holds_much());
    for (std::uint32_t arc = 0; arc < 1000; ++arc) ASSERT_EQ(lists.of(arc).data(), before[arc].data()) << arc;
    for (std::uint32_t arc = 0; arc < 3000; ++arc) ASSERT_EQ(unpacked(before[arc]), expected[arc]) << arc;
    const std::uint64_t held = lists.memory_bytes();
    lists.release();
    EXPECT_LT(lists.memory_bytes(), held);
    for (std::uint32_t arc = 0; arc < 3000; ++arc) ASSERT_EQ(unpacked(lists.of(arc)), plain[arc]) << arc;
  }
}

TEST(PackedLists, TheMostThatItHoldsIsTrue) {
  test::Random random(1);
  for (const std::uint32_t most : {1u, 8u, 700u, 3000u}) {
    PackedLists lists;
    lists.reserve(1000);
    std::uint64_t buckets = 0;
    for (std::uint32_t arc = 0; arc < 1000; ++arc) {
      const auto list = random_list(random, most);
      buckets += list.size();
      lists.add(list);
    }
    EXPECT_LE(lists.memory_bytes(), PackedLists::most_bytes(1000, buckets)) << most;
    EXPECT_GE(2 * lists.memory_bytes() + (128 << 10), PackedLists::most_bytes(1000, buckets)) << most;
  }
}

}  // namespace
}  // namespace reeb
