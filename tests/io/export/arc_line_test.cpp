// Lines of arcs: what smoothing keeps (ends, straight lines, hulls) and what it removes (zigzag).
#include "io/export/arc_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace reeb::io {
namespace {

using Point = std::array<double, 3>;

Bucket bucket(std::int64_t index, std::uint64_t count, const Point& mean) { return {index, count, mean}; }

std::vector<Point> drawn(const Point& lo, const std::vector<Bucket>& buckets, const Point& hi) {
  std::vector<Point> line{{9, 9, 9}};  // old content must be replaced
  draw_arc(lo, buckets, hi, line);
  return line;
}

TEST(ArcLine, HasNothingBetweenNodesWithoutBuckets) {
  EXPECT_TRUE(drawn({0, 0, 0}, {}, {1, 1, 1}).empty());
  EXPECT_TRUE(drawn({0, 0, 0}, {bucket(3, 0, {5, 5, 5})}, {1, 1, 1}).empty());
}

TEST(ArcLine, KeepsTheBucketOfAShortArc) {
  EXPECT_EQ(drawn({0, 0, 0}, {bucket(0, 7, {5, 6, 7})}, {1, 1, 1}), (std::vector<Point>{{5, 6, 7}}));
}

TEST(ArcLine, KeepsTheMiddleOfAStraightLine) {
  std::vector<Bucket> buckets;
  for (int i = 1; i <= 40; ++i) buckets.push_back(bucket(i, 10, {1.0 * i, 2.0 * i, -1.0 * i}));
  const auto line = drawn({0, 0, 0}, buckets, {41, 82, -41});
  ASSERT_EQ(line.size(), 40u);
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i][1], 2 * line[i][0], 1e-12) << i;
    EXPECT_NEAR(line[i][2], -line[i][0], 1e-12) << i;
    EXPECT_GT(line[i][0], i == 0 ? 0 : line[i - 1][0]) << i;
    const bool whole_window = i + 1 >= kLineReach && i + kLineReach <= 40;
    if (whole_window) {
      EXPECT_NEAR(line[i][0], 1.0 + static_cast<double>(i), 1e-12) << i;
    }
  }
}

TEST(ArcLine, StaysBetweenWhatItIsMadeOf) {
  std::mt19937_64 random(11);
  const auto coordinate = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
  for (int round = 0; round < 200; ++round) {
    std::vector<Bucket> buckets;
    for (std::size_t k = random() % 30; k-- > 0;)
      buckets.push_back(
          bucket(static_cast<std::int64_t>(buckets.size()), random() % 5, {coordinate(), coordinate(), coordinate()}));
    const auto filled = std::ranges::count_if(buckets, [](const Bucket& b) { return b.count != 0; });
    const auto line = drawn({coordinate(), 0, 0}, buckets, {0, coordinate(), 0});
    ASSERT_EQ(line.size(), static_cast<std::size_t>(filled));
    for (const Point& point : line)
      for (const double x : point) EXPECT_LE(std::abs(x), 1 + 1e-12);
  }
}

TEST(ArcLine, TakesZigzagAway) {
  std::vector<Bucket> buckets;
  for (int i = 1; i <= 40; ++i) buckets.push_back(bucket(i, 100, {i % 2 == 0 ? 1.0 : -1.0, 0, 1.0 * i}));
  for (const Point& point : drawn({0, 0, 0}, buckets, {0, 0, 41})) EXPECT_LT(std::abs(point[0]), 0.07);
}

TEST(ArcLine, IsHardlyBentByFewVertices) {
  std::vector<Bucket> buckets;
  for (int i = 1; i <= 40; ++i) buckets.push_back(bucket(i, i == 20 ? 1 : 10'000, {i == 20 ? 1.0 : 0.0, 0, 1.0 * i}));
  for (const Point& point : drawn({0, 0, 0}, buckets, {0, 0, 41})) EXPECT_LT(point[0], 0.002);
}

TEST(ArcLine, BendsIntoItsNodes) {
  // The centre of the contour is 10 away from the node. The line gets there in steps, of which the first is short.
  std::vector<Bucket> buckets;
  for (int i = 1; i <= 40; ++i) buckets.push_back(bucket(i, 100, {10, 0, 1.0 * i}));
  const auto line = drawn({0, 0, 0}, buckets, {10, 0, 41});
  EXPECT_LT(line[0][0], 6);
  for (std::size_t i = 1; i < line.size(); ++i) EXPECT_GE(line[i][0], line[i - 1][0]) << i;
  EXPECT_DOUBLE_EQ(line[kLineReach][0], 10);
}

// In a slab of a cone from k to k + 1, of radius k at k, the mean squared distance from the axis is (k + 1/2)^2 + 1/12,
// and that along the axis from its middle 1/12.
TEST(ArcLine, RadiiOfAConeAreThoseOfThePlacesOfThePoints) {
  std::vector<Bucket> buckets;
  for (int k = 0; k < 60; ++k) {
    buckets.push_back(bucket(k, 100, {0, 0, k + 0.5}));
    buckets.back().spread = static_cast<float>((k + 0.5) * (k + 0.5) + 2.0 / 12);
  }
  std::vector<double> radii;
  find_radii(buckets, radii);
  ASSERT_EQ(radii.size(), buckets.size());
  // The growth is known less well at the tip.
  for (std::size_t k = 0; k < radii.size(); ++k)
    EXPECT_NEAR(radii[k], static_cast<double>(k) + 0.5, (k == 0 ? 0.03 : 0.02) * radii[k]);
  const std::vector<Point> line = drawn({0, 0, 0}, buckets, {0, 0, 60});
  find_line_radii(0, buckets, 60, radii);
  ASSERT_EQ(radii.size(), line.size());
  for (std::size_t k = 0; k < radii.size(); ++k) EXPECT_NEAR(radii[k], line[k][2], 0.02 * line[k][2]) << k;
}

TEST(ArcLine, RadiiOfATubeDoNotGrowWithItsSlope) {
  std::vector<Bucket> buckets;
  for (int k = 0; k < 30; ++k) {  // the centre moves by 3 in a bucket
    buckets.push_back(bucket(k, 30, {3.0 * k, 1, 2}));
    buckets.back().spread = 4 + 9.0f / 12;
  }
  std::vector<double> radii;
  find_line_radii(0, buckets, 30, radii);
  ASSERT_EQ(radii.size(), buckets.size());
  for (const double radius : radii) EXPECT_NEAR(radius, 2, 1e-6);
}

TEST(ArcLine, IsFiniteForAllFiniteCoordinates) {
  for (const double x : {1e39, 1e160, 1.7e308}) {
    std::vector<Bucket> buckets = {bucket(0, 9, {x, -x, 1}), bucket(1, 9, {-x, -x, 1}), bucket(2, 9, {x, -x, 1})};
    for (Bucket& one : buckets) one.spread = std::numeric_limits<float>::max();
    for (const Point& point : drawn({x, -x, 0}, buckets, {x, -x, 0})) {
      EXPECT_LE(std::abs(point[0]), x);
      EXPECT_NEAR(point[1], -x, x * 1e-12);
    }
    std::vector<double> radii;
    find_radii(buckets, radii);
    EXPECT_EQ(radii.size(), 3u);
    for (const double radius : radii) EXPECT_TRUE(std::isfinite(radius));
  }
}

}  // namespace
}  // namespace reeb::io
