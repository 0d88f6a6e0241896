// Large triangles that reach into balls, against the distance of each triangle from each ball.
#include "ooc/patches/far_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "libreeb/base/vector3.h"
#include "ooc/patches/ball_clusters.h"
#include "tests/support/inputs/complex_mesh.h"

namespace reeb::test {
namespace {

using ooc::Ball;
using ooc::PatchBall;

// The distance of a triangle from a point, by points on it. Never too small.
double distance_at_most(const std::array<Point, 3>& t, const Point& p) {
  constexpr int kSteps = 40;
  double least = INFINITY;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) {
      Point at{};
      for (std::size_t k = 0; k < 3; ++k)
        at[k] = (t[0][k] * i + t[1][k] * j + t[2][k] * (kSteps - i - j)) / double{kSteps};
      least = std::min(least, distance(at, p));
    }
  return least;
}

double longest_side(const std::array<Point, 3>& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, std::max({t[0][k], t[1][k], t[2][k]}) - std::min({t[0][k], t[1][k], t[2][k]}));
  return longest;
}

TEST(FarTriangles, AreThoseThatReachIntoBalls) {
  std::mt19937_64 random(3);
  const auto real = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  std::vector<Ball> balls;
  for (int i = 0; i < 60; ++i) balls.push_back({{real(0, 100), real(0, 100), real(0, 30)}, std::exp(real(-1, 1.5))});
  const auto clusters = ooc::clusters_of(balls);
  std::vector<PatchBall> places(balls.size());
  for (std::uint32_t c = 0; c < clusters.size(); ++c)
    for (const std::uint32_t b : clusters[c]) places[b] = {balls[b], c, real(0.2, 1) * balls[b].radius};
  ASSERT_LT(clusters.size(), balls.size());

  ComplexMesh mesh{Complex{}};
  mesh.columns.assign(3, {});
  std::vector<std::array<Point, 3>> triangles;
  for (int i = 0; i < 4000; ++i) {
    const double size = i % 50 == 0 ? 100 : std::exp(real(-1, 2));
    const Point middle =
        i % 3 == 0 ? balls[random() % balls.size()].center : Point{real(-10, 110), real(-10, 110), real(-10, 40)};
    std::array<Point, 3> t{};
    for (Point& corner : t) {
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = middle[k] + real(-size, size);
        mesh.columns[k].push_back(corner[k]);
      }
      mesh.triangles.emplace_back(mesh.columns[0].size() - 1);
    }
    triangles.push_back(t);
  }
  IndexedComplex indexed(mesh);
  MemoryBudget budget;
  const auto found = ooc::find_far_triangles(indexed, places, clusters.size(), budget, [](const IndexedMesh&) {});
  ASSERT_EQ(found.of_patch.size(), clusters.size());
  std::size_t count = 0, must = 0;
  for (std::uint32_t c = 0; c < clusters.size(); ++c) {
    std::set<std::uint64_t> listed;
    for (const auto& t : found.of_patch[c]) {
      EXPECT_TRUE(listed.insert(t.corners[0].value() / 3).second);
      EXPECT_EQ(t.points, triangles[t.corners[0].value() / 3]);
    }
    count += listed.size();
    for (std::uint64_t i = 0; i < triangles.size(); ++i) {
      const auto& t = triangles[i];
      const auto inside = [&](const Point& p) {
        return std::ranges::any_of(clusters[c], [&](std::uint32_t b) { return balls[b].contains(p); });
      };
      const bool all_inside = std::ranges::all_of(t, inside);
      bool large = false, meets = false;
      for (const std::uint32_t b : clusters[c]) {
        if (longest_side(t) <= places[b].least) continue;
        large = true;
        meets = meets || distance_at_most(t, balls[b].center) <= balls[b].radius;
      }
      if (listed.contains(i)) {
        EXPECT_TRUE(large && !all_inside) << i;
      } else {
        EXPECT_FALSE(large && meets && !all_inside) << i;
      }
      must += large && meets && !all_inside ? 1u : 0u;
    }
  }
  EXPECT_GT(must, 500u);
  EXPECT_LT(count, 2 * must);  // few that only come near
  EXPECT_GE(budget.peak_bytes(), 100 * count);
}

}  // namespace
}  // namespace reeb::test
