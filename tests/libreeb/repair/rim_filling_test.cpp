// Fillings of rims: the least area by trying all triangulations; what refinement must keep.
#include "libreeb/repair/rim_filling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "libreeb/base/vector3.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

double area(const Point& a, const Point& b, const Point& c) {
  const Point u = b - a, w = c - a;
  const Point n = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
  return std::sqrt(dot(n, n)) / 2;
}

Rim rim_of(std::vector<Point> points) {
  Rim rim;
  rim.points = std::move(points);
  const std::size_t n = rim.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    Point beside = rim.points[i];
    for (std::size_t k = 0; k < 2; ++k) beside[k] *= 1.5;
    rim.beside.push_back(beside);
    rim.edge.push_back(distance(rim.points[i], rim.points[(i + 1) % n]));
  }
  return rim;
}

std::vector<Point> circle(std::size_t n, Random& random, double noise) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(n);
    points.push_back(
        {std::cos(angle) + noise * random.unit(), std::sin(angle) + noise * random.unit(), noise * random.unit()});
  }
  return points;
}

// The least area of all triangulations of the part from i to j.
double least_area(const Rim& rim, std::uint32_t i, std::uint32_t j) {
  if (j == i + 1) return 0;
  const bool is_whole = i == 0 && j + 1 == rim.points.size();
  if (!is_whole && std::ranges::find(rim.joined, std::pair(i, j)) != rim.joined.end())
    return std::numeric_limits<double>::infinity();
  double best = std::numeric_limits<double>::infinity();
  for (std::uint32_t k = i + 1; k < j; ++k)
    best = std::min(best,
                    least_area(rim, i, k) + least_area(rim, k, j) + area(rim.points[i], rim.points[k], rim.points[j]));
  return best;
}

TEST(RimFilling, HasTheLeastAreaAndRepeatsNoEdge) {
  Random random(3);
  for (std::size_t n = 3; n <= 9; ++n)
    for (int i = 0; i < 10; ++i) {
      Rim rim = rim_of(circle(n, random, 0.7));
      if (n > 4 && i % 2 == 0) rim.joined = {{0, 2}, {1, 3}};
      const auto filling = fill_rim(rim, {});
      const double expected = least_area(rim, 0, static_cast<std::uint32_t>(n - 1));
      if (!filling) {
        EXPECT_EQ(expected, std::numeric_limits<double>::infinity());
        continue;
      }
      double sum = 0;
      for (const auto& t : filling->triangles) sum += area(rim.points[t[0]], rim.points[t[1]], rim.points[t[2]]);
      EXPECT_NEAR(sum, expected, 1e-12);
      EXPECT_EQ(filling->triangles.size(), n - 2);
    }
  Rim closed = rim_of(circle(4, random, 0));
  closed.joined = {{0, 2}, {1, 3}};
  EXPECT_FALSE(fill_rim(closed, {}));
}

TEST(RimFilling, RefinesToADiscOfTheSameEdges) {
  Random random(4);
  for (const FillWeight weight : {FillWeight::kArea, FillWeight::kAngle})
    for (const std::size_t n : {11u, 30u, 80u}) {
      const Rim rim = rim_of(circle(n, random, 0));
      const auto filling = fill_rim(rim, {weight, true, true});
      ASSERT_TRUE(filling);
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // directed
      double sum = 0;
      const auto point = [&](std::uint32_t v) { return v < n ? rim.points[v] : filling->vertices[v - n].position; };
      for (const auto& t : filling->triangles) {
        sum += area(point(t[0]), point(t[1]), point(t[2]));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(++edges[std::pair(t[k], t[(k + 1) % 3])], 1);
      }
      for (const auto& [edge, times] : edges) {
        const bool on_rim = (edge.first + 1) % n == edge.second && edge.first < n;
        EXPECT_NE(edges.contains(std::pair(edge.second, edge.first)), on_rim);
      }
      for (std::uint32_t i = 0; i < n; ++i)
        EXPECT_TRUE(edges.contains(std::pair(i, (i + 1) % static_cast<std::uint32_t>(n))));
      EXPECT_EQ(filling->triangles.size(), n - 2 + 2 * filling->vertices.size());
      const double disc = 0.5 * static_cast<double>(n) * std::sin(2 * 3.14159265358979 / static_cast<double>(n));
      EXPECT_NEAR(sum, disc, 1e-5);
      if (n == 80) {
        EXPECT_GT(filling->vertices.size(), 200u);
      }
      for (std::size_t v = 0; v < filling->vertices.size(); ++v) {
        for (const std::uint32_t parent : filling->vertices[v].parents) EXPECT_LT(parent, n + v);
        for (const double x : filling->vertices[v].position) EXPECT_EQ(x, static_cast<double>(static_cast<float>(x)));
      }
    }
}

}  // namespace
}  // namespace reeb::test
