#include "ooc/sorting/sort_buffer.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace reeb::ooc {
namespace {

struct Plain {
  std::uint64_t number = 0;
};

// An allowance that rises by a hundredth at a time must not copy the buffer every time.
TEST(SortBuffer, GrowsByAQuarterAtLeast) {
  MemoryBudget budget;
  SortBuffer<Plain> buffer{{}, budget.reserve("records", 0)};
  buffer.start(1000);
  std::size_t growths = 0;
  for (std::uint64_t most = 8000; most < 80000; most += most / 100) {
    const std::size_t before = buffer.room;
    if (!buffer.grow_records(1000, most)) continue;
    ++growths;
    EXPECT_GT(buffer.room, before + before / 4);
    EXPECT_LE(buffer.room * sizeof(Plain), most);
    EXPECT_LE(buffer.room, buffer.batch.records.capacity());
    EXPECT_EQ(buffer.charge.bytes(), buffer.room * sizeof(Plain));
  }
  EXPECT_GE(growths, 5u);
  EXPECT_LE(growths, 11u);  // 1.25^11 is more than 10
}

// Up to 3 MiB it is copied once.
TEST(SortBuffer, GrowsInPlace) {
  MemoryBudget budget;
  SortBuffer<Plain> buffer{{}, budget.reserve("records", 0)};
  buffer.start(1000);
  buffer.batch.records.resize(1000);
  ASSERT_TRUE(buffer.grow_records(1000, 16000));
  EXPECT_EQ(buffer.room, 2000u);
  EXPECT_EQ(budget.peak_bytes(), 24000u);  // both copies
  const Plain* const records = buffer.batch.records.data();
  for (std::uint64_t most = 16000; most <= 3 << 20; most *= 2) buffer.grow_records(1000, most);
  EXPECT_EQ(buffer.batch.records.data(), records);
  EXPECT_GT(buffer.room, 200'000u);
  EXPECT_EQ(budget.peak_bytes(), buffer.room * sizeof(Plain));
}

// What is not used counts, since it will be used before the buffer is sorted.
TEST(SortBuffer, DoesNotGrowBeyondTheBudget) {
  MemoryBudget budget(30000);
  SortBuffer<Plain> buffer{{}, budget.reserve("records", 0)};
  buffer.start(1000);
  ASSERT_TRUE(buffer.grow_records(1000, 16000));
  EXPECT_FALSE(buffer.grow_records(1000, 32000));
  EXPECT_EQ(buffer.room, 2000u);
}

TEST(SortBuffer, APoolGrowsByAQuarterAtLeast) {
  MemoryBudget budget;
  SortBuffer<Plain> buffer{{}, budget.reserve("records", 0)};
  ASSERT_TRUE(buffer.grow_pool(1000, 1000));
  EXPECT_TRUE(buffer.grow_pool(1000, 1000));  // there is room
  buffer.batch.pool.resize(1000);
  EXPECT_FALSE(buffer.grow_pool(100, 1200));
  EXPECT_EQ(buffer.batch.pool.capacity(), 1000u);
  EXPECT_FALSE(buffer.grow_pool(500, 1400));  // more than it may have
  ASSERT_TRUE(buffer.grow_pool(100, 1300));
  EXPECT_EQ(buffer.batch.pool.capacity(), 1300u);
}

}  // namespace
}  // namespace reeb::ooc
