// The sizes of chunks of a mesh in rows.
#include "ooc/chunks/chunk_growth.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace reeb::ooc {
namespace {

constexpr ChunkSize kSize{.first = 1024, .most = 16384};

// Half a vertex a triangle and a row on top. The vertices of the lowest and the highest row are shared.
Chunk strip(std::size_t triangles, std::size_t row) {
  Chunk chunk;
  chunk.corners.resize(3 * triangles);
  chunk.ids.resize(triangles / 2 + row);
  chunk.uses.assign(chunk.ids.size(), kUsedHereOnly);
  for (std::size_t i = 0; i < row; ++i) {
    chunk.uses[i] |= kUsedEarlier;
    chunk.uses[chunk.uses.size() - 1 - i] |= kUsedLater;
  }
  return chunk;
}

std::vector<std::size_t> sizes_of_strips(std::size_t row, std::size_t chunks) {
  ChunkGrowth growth(kSize);
  std::vector<std::size_t> sizes;
  for (std::size_t i = 0; i < chunks; ++i) {
    sizes.push_back(growth.size());
    growth.adapt(strip(growth.size(), row));
  }
  return sizes;
}

TEST(ChunkGrowth, StripsSettleWhereAQuarterOrLessIsShared) {
  for (std::size_t row = 1; row < 2000; row += 7) {
    const std::vector<std::size_t> sizes = sizes_of_strips(row, 24);
    const std::size_t size = sizes.back();
    for (std::size_t i = 12; i < sizes.size(); ++i) ASSERT_EQ(sizes[i], size) << row;
    const double shared = 2.0 * static_cast<double>(row) / (static_cast<double>(size) / 2 + static_cast<double>(row));
    EXPECT_TRUE(shared <= (size == kSize.first ? 0.25 : 0.12) || size == kSize.most) << row;
  }
}

// Chunks of 16,384 triangles of a scan in patches share 9 % of their vertices, and a few of them 13 %.
TEST(ChunkGrowth, CompactChunksOfTheFirstSizeStayAsTheyAre) {
  constexpr ChunkSize kLarge{.first = 16384, .most = 524288};
  ChunkGrowth growth(kLarge);
  for (const std::size_t row : {400u, 600u, 700u}) growth.adapt(strip(growth.size(), row));
  EXPECT_EQ(growth.size(), kLarge.first);
  growth.adapt(strip(growth.size(), 1000));
  EXPECT_EQ(growth.size(), 2 * kLarge.first);
  growth.adapt(strip(growth.size(), 600));
  EXPECT_EQ(growth.size(), kLarge.first);
}

TEST(ChunkGrowth, LargeChunksGrowInSmallerSteps) {
  EXPECT_EQ(sizes_of_strips(2000, 8), (std::vector<std::size_t>{1024, 2048, 4096, 8192, 12288, 16384, 16384, 16384}));
}

TEST(ChunkGrowth, ChunksShrinkWhereLittleIsShared) {
  ChunkGrowth growth(kSize);
  for (int i = 0; i < 8; ++i) growth.adapt(strip(growth.size(), 2000));
  ASSERT_EQ(growth.size(), kSize.most);
  for (int i = 0; i < 8; ++i) growth.adapt(strip(growth.size(), 1));
  EXPECT_EQ(growth.size(), kSize.first);
}

}  // namespace
}  // namespace reeb::ooc
