// What ChunkStars says of the edges up from a vertex, against the definition, on random triangles of few vertices: so
// edges have any number of triangles, and many triangles are degenerate or equal.
#include "libreeb/sweep/chunk_stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

// The groups of edges up from v: edges of a triangle with v as its lowest corner are in the same group.
std::size_t groups_above(const ChunkStars& stars, std::uint32_t v) {
  std::vector<std::vector<std::uint32_t>> groups;
  const auto add = [&](std::vector<std::uint32_t> ends) {
    for (auto group = groups.begin(); group != groups.end();) {
      if (std::ranges::find_first_of(*group, ends) == group->end()) {
        ++group;
        continue;
      }
      ends.insert(ends.end(), group->begin(), group->end());
      group = groups.erase(group);
    }
    groups.push_back(std::move(ends));
  };
  for (std::uint32_t t = 0; t < stars.triangle_count(); ++t) {
    const auto [lo, mid, hi, place] = stars[t];
    if (lo == v) add({mid, hi});
    if (mid == v && hi != v) add({hi});
  }
  return groups.size();
}

// Whether an edge up from v has three triangles or more.
bool has_third_triangle_above(const ChunkStars& stars, std::uint32_t v) {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t t = 0; t < stars.triangle_count(); ++t) {
    const auto [lo, mid, hi, place] = stars[t];
    if (lo == v && mid != hi) ends.push_back(mid);
    if (lo == v || (mid == v && hi != v)) ends.push_back(hi);
  }
  return std::ranges::any_of(ends, [&](std::uint32_t end) { return std::ranges::count(ends, end) > 2; });
}

TEST(ChunkStars, RecognizeSmallStarsWhoseUpperEdgesAreConnected) {
  test::Random random(test::base_seed());
  std::size_t recognized = 0, small = 0, with_third = 0;
  for (int round = 0; round < 10000; ++round) {
    Chunk chunk;
    const auto vertices = 4 + static_cast<std::uint32_t>(random.below(5));
    for (std::uint64_t v = 0; v < vertices; ++v) chunk.ids.emplace_back(v);
    chunk.uses.assign(vertices, kUsedHereOnly);
    for (auto n = 3 * (1 + random.below(9)); n > 0; --n)
      chunk.corners.push_back(static_cast<std::uint32_t>(random.below(vertices)));
    std::vector<std::uint32_t> order(vertices);
    std::iota(order.begin(), order.end(), 0u);
    random.shuffle(order);
    ChunkStars stars;
    stars.build(chunk, order);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      const std::size_t lows = stars.low_last(v) - stars.low_first(v), middles = stars.middles(v).size();
      const bool is_small = lows >= 1 && lows <= 3 && middles >= 1 && middles <= 2;
      const bool expected = is_small && groups_above(stars, v) == 1, has_third = has_third_triangle_above(stars, v);
      ASSERT_EQ(stars.is_small_and_connected_above(v, false), expected) << "round " << round;
      ASSERT_EQ(stars.is_small_and_connected_above(v, true), expected && !has_third) << "round " << round;
      small += is_small ? 1u : 0u;
      recognized += expected ? 1u : 0u;
      with_third += expected && has_third ? 1u : 0u;
    }
  }
  EXPECT_GT(recognized, 500u);
  EXPECT_GT(small - recognized, 500u);
  EXPECT_GT(with_third, 500u);
  EXPECT_GT(recognized - with_third, 500u);
}

}  // namespace
}  // namespace reeb
