// Which balls contain a point, and which meet, against looking at all of them.
#include "ooc/patches/ball_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "libreeb/base/vector3.h"
#include "ooc/patches/ball_clusters.h"
#include "ooc/patches/space_order.h"

namespace reeb::test {
namespace {

using ooc::Ball;

Point random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  return {coordinate(random), coordinate(random), coordinate(random) / 10};
}

std::vector<Ball> random_balls(std::mt19937& random, std::size_t count) {
  std::vector<Ball> balls;
  for (std::size_t i = 0; i < count; ++i)
    balls.push_back({random_point(random, 100), std::exp(std::uniform_real_distribution<double>(-4, 3)(random))});
  balls.push_back({{1, 2, 3}, 0});
  balls.push_back({{1e300, 0, 0}, 1e-300});
  return balls;
}

TEST(BallGrid, VisitsTheBallsThatContainAPoint) {
  std::mt19937 random(5);
  const std::vector<Ball> balls = random_balls(random, 500);
  const ooc::BallGrid grid(balls);
  std::size_t most = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Point point = random_point(random, 120);
    std::set<std::uint32_t> expected, visited;
    for (std::uint32_t b = 0; b < balls.size(); ++b)
      if (balls[b].radius > 0 && balls[b].contains(point)) expected.insert(b);
    grid.visit(point, [&](std::uint32_t ball) {
      visited.insert(ball);
      return true;
    });
    ASSERT_EQ(visited, expected);
    const std::uint32_t found = grid.find(point);
    ASSERT_TRUE(expected.empty() ? found == ooc::BallGrid::kNone : expected.contains(found));
    most = std::max(most, expected.size());
  }
  EXPECT_GE(most, 3u);
  EXPECT_EQ(ooc::BallGrid({}).find({0, 0, 0}), ooc::BallGrid::kNone);
}

TEST(BallClusters, AreConnectedByBallsThatMeet) {
  std::mt19937 random(6);
  const std::vector<Ball> balls = random_balls(random, 300);
  std::vector<std::uint32_t> cluster(balls.size());
  for (std::uint32_t i = 0; i < balls.size(); ++i) cluster[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t i = 0; i < balls.size(); ++i)
      for (std::uint32_t k = 0; k < i; ++k) {
        const bool meet = distance(balls[i].center, balls[k].center) <= balls[i].radius + balls[k].radius;
        if (!meet || cluster[i] == cluster[k]) continue;
        cluster[i] = cluster[k] = std::min(cluster[i], cluster[k]);
        changed = true;
      }
  }
  std::vector<std::vector<std::uint32_t>> expected;
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    if (cluster[i] != i) continue;
    expected.emplace_back();
    for (std::uint32_t k = i; k < balls.size(); ++k)
      if (cluster[k] == i) expected.back().push_back(k);
  }
  EXPECT_EQ(ooc::clusters_of(balls), expected);
  EXPECT_GT(expected.size(), 10u);
  EXPECT_LT(expected.size(), balls.size() - 10);
}

TEST(OrderInSpace, HasNeighboursNearEachOther) {
  std::mt19937 random(8);
  std::vector<Point> points(1000);
  for (Point& point : points) point = random_point(random, 1);
  points.push_back(points[17]);
  const std::vector<std::uint32_t> order = ooc::order_in_space(points);
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < points.size(); ++i) ASSERT_EQ(sorted[i], i);
  double given = 0, ordered = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    given += distance(points[i - 1], points[i]);
    ordered += distance(points[order[i - 1]], points[order[i]]);
  }
  EXPECT_LT(ordered, given / 5);
  const auto place = std::ranges::find(order, 17u);
  EXPECT_EQ(place[1], 1000u);
}

}  // namespace
}  // namespace reeb::test
