#include "ooc/whole_mesh/vertex_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

using Positions = std::vector<std::array<double, 3>>;

// The positions in the order of the curve.
Positions along_curve(const Positions& positions, std::size_t axes, std::uint64_t slabs) {
  std::vector<double> values;
  for (std::size_t a = 0; a < axes; ++a)
    for (const auto& position : positions) values.push_back(position[a]);
  CurveBox box(axes);
  for (std::size_t a = 0; a < axes; ++a) box.add(a, std::span(values).subspan(a * positions.size(), positions.size()));
  std::vector<std::uint64_t> places(positions.size());
  VertexCurve(box, slabs).places(values, places);
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  Positions sorted;
  for (const std::size_t i : order) sorted.push_back(positions[i]);
  return sorted;
}

TEST(VertexCurve, GoesFromEachCellToOneBesideIt) {
  constexpr int kSide = 16;
  Positions grid;
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z)
        grid.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  test::Random(3).shuffle(grid);
  const Positions sorted = along_curve(grid, 3, 1);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    double steps = 0;
    for (std::size_t a = 0; a < 3; ++a) steps += std::abs(sorted[i][a] - sorted[i - 1][a]);
    ASSERT_EQ(steps, 1) << i;
  }
}

TEST(VertexCurve, SlabsAcrossTheLongestAxisComeOneAfterTheOther) {
  test::Random random(test::base_seed());
  for (int round = 0; round < 50; ++round) {
    const std::size_t longest = random.below(3);
    const std::uint64_t slabs = random.between(2, 40);
    Positions positions(500);
    for (auto& position : positions)
      for (std::size_t a = 0; a < 3; ++a) position[a] = random.unit() * (a == longest ? 900 : 300) - 100;
    const auto [low, high] = std::minmax_element(positions.begin(), positions.end(),
                                                 [&](const auto& a, const auto& b) { return a[longest] < b[longest]; });
    const double bottom = (*low)[longest], size = (*high)[longest] - bottom;
    double most = bottom;
    for (const auto& position : along_curve(positions, 3, slabs)) {
      ASSERT_GT(position[longest], most - size / static_cast<double>(slabs) * 1.001) << slabs << " slabs";
      most = std::max(most, position[longest]);
    }
  }
}

TEST(VertexCurve, APointAndAMeshWithoutAxesHaveOnePlace) {
  const Positions same(100, {1, 2, 3});
  EXPECT_EQ(along_curve(same, 3, 1), same);
  EXPECT_EQ(along_curve(same, 0, 7), same);
}

TEST(VertexCurve, SlabsAreAboutAHundredEdgesThick) {
  EXPECT_EQ(VertexCurve::slab_count(0), 1u);
  EXPECT_EQ(VertexCurve::slab_count(10000), 1u);
  EXPECT_EQ(VertexCurve::slab_count(1280ull * 1280), 10u);
  EXPECT_EQ(VertexCurve::slab_count(~std::uint64_t{0}), 4096u);
}

}  // namespace
}  // namespace reeb::ooc
