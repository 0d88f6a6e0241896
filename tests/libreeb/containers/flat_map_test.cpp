// FlatMap against std::unordered_map, on random operations. The tables stay small, so that these are frequent: entries
// with the same home, gaps that are closed, and runs of entries that wrap around the end of the table.
#include "libreeb/containers/flat_map.h"

#include <gtest/gtest.h>

#include <unordered_map>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

using Map = FlatMap;

void expect_same(const Map& map, const std::unordered_map<std::uint64_t, std::uint32_t>& model, std::uint64_t keys) {
  ASSERT_EQ(map.size(), model.size());
  for (std::uint64_t key = 0; key < keys; ++key) {
    const auto entry = model.find(key);
    ASSERT_EQ(map.find(key), entry == model.end() ? Map::kNone : entry->second) << "key " << key;
  }
}

// Inserts and erases, with about `share` per cent of the keys in the map.
void play(std::uint64_t seed, std::uint64_t keys, std::uint64_t share) {
  test::Random random(seed);
  Map map;
  std::unordered_map<std::uint64_t, std::uint32_t> model;
  for (std::uint32_t step = 0; step < 400; ++step) {
    const std::uint64_t key = random.below(keys);
    if (random.below(100) < share) {
      const std::uint32_t value = model.try_emplace(key, step).first->second;
      ASSERT_EQ(map.find_or_insert(key, step), value);
    } else {
      map.erase(key);
      model.erase(key);
    }
    if (random.below(200) == 0) {
      map.clear();
      model.clear();
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(map, model, keys));
  }
}

TEST(FlatMap, IsAMapWhateverIsInsertedAndErased) {
  const std::uint64_t base = test::base_seed();
  for (std::uint64_t i = 0; i < test::case_count(300) && !testing::Test::HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    play(base + i, 4 + i % 60, 20 + i % 7 * 10);
  }
}

TEST(FlatMap, GrowsAndShrinksWithManyEntries) {
  constexpr std::uint64_t kEntries = 20'000;
  test::Random random(test::base_seed());
  Map map;
  std::unordered_map<std::uint64_t, std::uint32_t> model;
  for (std::uint32_t i = 0; i < kEntries; ++i) {
    const std::uint64_t key = random.next();
    map.find_or_insert(key, i);
    model.try_emplace(key, i);
  }
  const std::size_t bytes = map.memory_bytes();
  EXPECT_GE(bytes, kEntries * 12);
  while (!model.empty()) {
    const auto [key, value] = *model.begin();
    ASSERT_EQ(map.find(key), value);
    map.erase(key);
    model.erase(model.begin());
    ASSERT_EQ(map.find(key), Map::kNone);
    ASSERT_EQ(map.size(), model.size());
  }
  EXPECT_EQ(map.memory_bytes(), bytes);
}

TEST(FlatMap, IsEmptyAtFirst) {
  Map map;
  map.erase(7);
  map.clear();
  EXPECT_EQ(map.size(), 0u);
  EXPECT_EQ(map.find(7), Map::kNone);
  EXPECT_EQ(map.memory_bytes(), 0u);
}

}  // namespace
}  // namespace reeb
