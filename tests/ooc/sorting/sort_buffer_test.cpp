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
    const std::size_t before = buffer.batch.records.capacity();
    if (!buffer.grow_records(1000, most)) continue;
    ++growths;
    EXPECT_GT(buffer.batch.records.capacity(), before + before / 4);
    EXPECT_LE(buffer.batch.records.capacity() * sizeof(Plain), most);
    EXPECT_EQ(buffer.charge.bytes(), buffer.batch.records.capacity() * sizeof(Plain));
  }
  EXPECT_GE(growths, 5u);
  EXPECT_LE(growths, 11u);  // 1.25^11 is more than 10
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
