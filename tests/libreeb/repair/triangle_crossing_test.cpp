// Exact sides and crossing triangles, against rational numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <vector>

#include "libreeb/repair/exact_sign.h"
#include "libreeb/repair/triangle_crossing.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Exact = std::array<Rational, 3>;

Exact exact(const Point& p) { return {Rational(p[0]), Rational(p[1]), Rational(p[2])}; }
Exact minus(const Exact& a, const Exact& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Exact cross(const Exact& u, const Exact& w) {
  return {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
}
Rational inner(const Exact& u, const Exact& w) { return u[0] * w[0] + u[1] * w[1] + u[2] * w[2]; }

// Integers, or numbers that are nearly in one plane.
Point random_point(Random& random, int kind) {
  Point p{};
  for (double& x : p) x = static_cast<double>(random.below(4));
  if (kind == 1)
    for (double& x : p) x += std::ldexp(random.unit() - 0.5, -50);
  if (kind == 2) p[2] = p[0] * 0.1 + p[1] * 0.7;
  return p;
}

TEST(ExactSign, IsThatOfRationals) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    std::array<Point, 4> p;
    for (Point& point : p) point = random_point(random, i % 3);
    const Exact a = exact(p[0]);
    const Exact u = minus(exact(p[1]), a), v = minus(exact(p[2]), a), w = minus(exact(p[3]), a), n = cross(u, v);
    ASSERT_EQ(side_of_plane(p[0], p[1], p[2], p[3]), inner(n, w).sign()) << i;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(turn_without(k, p[0], p[1], p[2]), n[k].sign()) << i;
  }
}

// The part of a polygon where inner(normal, p - at) >= 0.
std::vector<Exact> clipped(const std::vector<Exact>& polygon, const Exact& normal, const Exact& at) {
  std::vector<Exact> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Exact &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational a = inner(normal, minus(p, at)), b = inner(normal, minus(q, at));
    if (a >= 0) result.push_back(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      Exact x;
      for (std::size_t k = 0; k < 3; ++k) x[k] = p[k] + (q[k] - p[k]) * (a / (a - b));
      result.push_back(x);
    }
  }
  return result;
}

bool reference_cross(const PlacedTriangle& s, const PlacedTriangle& t) {
  std::vector<Exact> polygon, other, shared;
  for (std::size_t i = 0; i < 3; ++i) {
    polygon.push_back(exact(s.points[i]));
    other.push_back(exact(t.points[i]));
    if (std::ranges::find(t.corners, s.corners[i]) != t.corners.end()) shared.push_back(polygon.back());
  }
  if (shared.size() == 3) return true;
  const Exact normal = cross(minus(other[1], other[0]), minus(other[2], other[0]));
  const Exact negative = {-normal[0], -normal[1], -normal[2]};
  polygon = clipped(clipped(polygon, normal, other[0]), negative, other[0]);
  for (std::size_t i = 0; i < 3; ++i)
    polygon = clipped(polygon, cross(normal, minus(other[(i + 1) % 3], other[i])), other[i]);
  return std::ranges::any_of(polygon, [&](const Exact& p) {
    if (shared.empty()) return true;
    const Exact d = minus(p, shared[0]);
    if (shared.size() == 1) return d != Exact{};
    const Exact edge = minus(shared[1], shared[0]);
    const Rational along = inner(d, edge);
    return cross(d, edge) != Exact{} || along < 0 || along > inner(edge, edge);
  });
}

TEST(TriangleCrossing, IsThatOfRationals) {
  Random random(2);
  std::size_t crossing = 0, tested = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Point, 6> points;
    for (Point& point : points) point = random_point(random, i % 3);
    const auto triangle = [&](std::uint32_t first, std::uint32_t shift) {
      PlacedTriangle t;
      for (std::uint32_t k = 0; k < 3; ++k) {
        t.corners[k] = first + (k + shift) % 3;
        t.points[k] = points[t.corners[k]];
      }
      return t;
    };
    const PlacedTriangle s = triangle(0, static_cast<std::uint32_t>(random.below(3)));
    const PlacedTriangle t = triangle(static_cast<std::uint32_t>(random.below(4)), 1);
    if (is_flat(s) || is_flat(t)) continue;
    ++tested;
    const bool expected = reference_cross(s, t);
    crossing += expected ? 1u : 0u;
    ASSERT_EQ(triangles_cross(s, t), expected) << i;
    ASSERT_EQ(triangles_cross(t, s), expected) << i;
  }
  EXPECT_GT(tested, 1500u);
  EXPECT_GT(crossing, 300u);
  EXPECT_LT(crossing, tested - 300);
}

}  // namespace
}  // namespace reeb::test
