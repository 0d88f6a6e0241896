// Curves around a tube whose edges run askew.
#include "libreeb/repair/tight_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/curve_cut.h"

namespace reeb::test {
namespace {

constexpr double kTurn = 2 * 3.14159265358979;
constexpr std::uint32_t kAround = 40, kAcross = 8;
constexpr double kRadius = 2;

std::uint32_t at(std::uint32_t i, std::uint32_t j, std::uint32_t skew) {
  return (i + j / kAcross * skew * kAcross) % kAround * kAcross + j % kAcross;
}

// A torus of which the ring j is turned by j times `skew` edges.
EditablePatch torus(std::uint32_t skew) {
  EditablePatch patch;
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double u = kTurn * (i + skew * j) / kAround, w = kTurn * j / kAcross, r = 10 + kRadius * std::cos(w);
      patch.add_vertex(
          {VertexId(i * kAcross + j), {r * std::cos(u), r * std::sin(u), kRadius * std::sin(w)}, true, false, {}});
    }
  std::uint64_t id = 0;
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const std::uint32_t a = at(i, j, skew), b = at(i + 1, j, skew), c = at(i + 1, j + 1, skew),
                          d = at(i, j + 1, skew);
      patch.add_triangle({a, b, c}, id++);
      patch.add_triangle({a, c, d}, id++);
    }
  return patch;
}

// Once around the small circle, along edges: up each askew edge, and back along the ring.
std::vector<std::uint32_t> stairs(std::uint32_t skew) {
  std::vector<std::uint32_t> path;
  for (std::uint32_t j = 0; j < kAcross; ++j) {
    const std::uint32_t i = 2 * kAround - skew * j;
    path.push_back(at(i, j, skew));
    for (std::uint32_t k = 0; k < skew; ++k) path.push_back(at(i - k, j + 1, skew));
  }
  return path;
}

double length_of(const EditablePatch& patch, const std::vector<std::uint32_t>& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += distance(patch.position(loop[i]), patch.position(loop[(i + 1) % loop.size()]));
  return sum;
}

struct Count {
  std::int64_t euler = 0;
  bool closed = true;
};
Count count(const EditablePatch& patch) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::set<std::uint32_t> used;
  std::int64_t triangles = 0;
  Count result;
  for (std::uint32_t t = 0; t < patch.triangle_count(); ++t) {
    if (!patch.triangle(t).there) continue;
    ++triangles;
    const auto& c = patch.triangle(t).corners;
    for (std::size_t i = 0; i < 3; ++i) {
      result.closed = edges.emplace(c[i], c[(i + 1) % 3]).second && result.closed;
      used.insert(c[i]);
    }
  }
  for (const auto& [a, b] : edges) result.closed = result.closed && edges.contains({b, a});
  result.euler = static_cast<std::int64_t>(used.size()) - static_cast<std::int64_t>(edges.size()) / 2 + triangles;
  return result;
}

TEST(TightCurve, RunsThroughTrianglesWhereEdgesAreAskew) {
  EditablePatch patch = torus(2);
  const auto curve = stairs(2);
  const double circle = kTurn * kRadius, before = length_of(patch, curve);
  for (std::size_t i = 0; i < curve.size(); ++i)
    ASSERT_TRUE(patch.has_edge(curve[i], curve[(i + 1) % curve.size()])) << i;
  ASSERT_GT(before, 1.5 * circle);
  const auto tight = pull_tight(patch, curve, 0.85, false);
  ASSERT_TRUE(tight);
  // The surface is near the round torus, on which it would be the circle.
  EXPECT_LT(tight->length, 1.08 * circle);
  EXPECT_GT(tight->length, 0.9 * circle);
  EXPECT_NEAR(length_of(patch, tight->curve), tight->length, 1e-9);
  for (std::size_t i = 0; i < tight->curve.size(); ++i)
    EXPECT_TRUE(patch.has_edge(tight->curve[i], tight->curve[(i + 1) % tight->curve.size()])) << i;
  EXPECT_TRUE(count(patch).closed);
  EXPECT_EQ(count(patch).euler, 0);
  undo_split(patch, tight->split);
  EXPECT_EQ(patch.vertex_count(), kAround * kAcross);
  // A curve that is nearly as short is left.
  EditablePatch straight = torus(0);
  EXPECT_FALSE(pull_tight(straight, stairs(0), 0.85, false));
  EXPECT_EQ(straight.vertex_count(), kAround * kAcross);
}

TEST(TightCurve, IsWhatACutRunsAlong) {
  for (const bool float32 : {false, true}) {
    EditablePatch patch = torus(2);
    const Cut cut = cut_along(patch, stairs(2), {float32});
    ASSERT_TRUE(cut.done) << cut.why;
    EXPECT_TRUE(cut.connected);
    EXPECT_TRUE(count(patch).closed);
    EXPECT_EQ(count(patch).euler, 2);
    // Vertices of the mesh are on the rim, and places between them.
    EXPECT_GT(std::ranges::count_if(cut.first_side, [](std::uint32_t v) { return v >= kAround * kAcross; }), 3);
    if (!float32) continue;
    for (std::uint32_t v = kAround * kAcross; v < patch.vertex_count(); ++v)
      for (const double x : patch.position(v)) EXPECT_EQ(static_cast<double>(static_cast<float>(x)), x);
  }
}

}  // namespace
}  // namespace reeb::test
