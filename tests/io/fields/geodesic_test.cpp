// Distances against closed forms, and against shortest paths along edges.
#include "io/fields/geodesic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>

#include "libreeb/base/error.h"
#include "tests/io/fields/made_surfaces.h"

namespace reeb::io {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::vector<double> distance(const WholeComplex& complex, std::vector<std::uint32_t> sources) {
  MemoryBudget budget;
  return geodesic_distance(complex, sources, budget);
}

// By definition: each edge as often as there are vertices.
std::vector<double> along_edges(const WholeComplex& complex, std::uint32_t source) {
  std::vector<double> result(complex.vertex_count(), kInfinite);
  result[source] = 0;
  const auto pass = [&](std::uint32_t a, std::uint32_t b) {
    const double length = complex.length(a, b);
    const bool shorter = result[a] + length < result[b] || result[b] + length < result[a];
    result[b] = std::min(result[b], result[a] + length);
    result[a] = std::min(result[a], result[b] + length);
    return shorter;
  };
  for (bool changes = true; changes;) {
    changes = false;
    for (const auto& t : complex.triangles) {
      changes |= pass(t[0], t[1]);
      changes |= pass(t[1], t[2]);
      changes |= pass(t[2], t[0]);
    }
    for (const auto& e : complex.edges) changes |= pass(e[0], e[1]);
  }
  return result;
}

struct Errors {
  double least = 0, most = 0, mean = 0;  // relative
};

template <class Exact>
Errors errors_of(const std::vector<double>& d, const Exact& exact) {
  Errors errors;
  for (std::uint32_t v = 0; v < d.size(); ++v) {
    if (exact(v) == 0) continue;
    const double error = d[v] / exact(v) - 1;
    errors.least = std::min(errors.least, error);
    errors.most = std::max(errors.most, error);
    errors.mean += std::abs(error) / static_cast<double>(d.size());
  }
  return errors;
}

// geodesic.h promises these bounds.
TEST(Geodesic, InAPlaneIsTheDistanceOfPoints) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WholeComplex plane = testing::random_plane(30, seed);
    for (const std::uint32_t source : {0u, 7u, 480u}) {
      const auto errors =
          errors_of(distance(plane, {source}), [&](std::uint32_t v) { return plane.length(source, v); });
      EXPECT_GT(errors.least, -1e-6);
      EXPECT_LT(errors.most, 0.02);
      EXPECT_LT(errors.mean, 0.0005);
    }
  }
}

TEST(Geodesic, IsTheSameAtEveryScale) {
  const auto expected = distance(testing::random_plane(20, 3), {7});
  for (const int exponent : {-1000, -600, -520, -1, 10, 520, 1000}) {
    WholeComplex plane = testing::random_plane(20, 3);
    for (double& x : plane.coordinates) x = std::ldexp(x, exponent);
    use_unit_of_edges(plane);
    const auto d = distance(plane, {7});
    for (std::size_t v = 0; v < d.size(); ++v) ASSERT_EQ(d[v], std::ldexp(expected[v], exponent)) << exponent;
  }
}

// Triangles that are not obtuse.
TEST(Geodesic, InARegularPlaneIsExact) {
  WholeComplex plane;
  constexpr std::uint32_t kSide = 20;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      plane.coordinates.insert(plane.coordinates.end(), {x + 0.5 * y, std::sqrt(0.75) * y, 0});
      if (x == 0 || y == 0) continue;
      const std::uint32_t d = y * kSide + x, c = d - 1, b = d - kSide, a = b - 1;
      plane.triangles.insert(plane.triangles.end(), {{a, b, c}, {b, d, c}});
    }
  const auto d = distance(plane, {0});
  for (std::uint32_t v = 0; v < plane.vertex_count(); ++v) EXPECT_NEAR(d[v], plane.length(0, v), 1e-9) << v;
}

// Corners of up to 170 degrees: a grid of squares that is sheared, with either diagonal.
TEST(Geodesic, ObtuseCornersInAPlane) {
  constexpr std::uint32_t kSide = 30;
  for (const double shear : {-6.0, -3.0, -1.5, 0.0, 1.0, 1.5, 2.0, 3.0, 6.0}) {
    WholeComplex plane;
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t x = 0; x < kSide; ++x) {
        plane.coordinates.insert(plane.coordinates.end(), {x + shear * y, 1.0 * y, 0});
        if (x == 0 || y == 0) continue;
        const std::uint32_t d = y * kSide + x, c = d - 1, b = d - kSide, a = b - 1;
        plane.triangles.insert(plane.triangles.end(), {{a, b, d}, {a, d, c}});
      }
    const std::uint32_t source = kSide * kSide / 2 + kSide / 2;
    const auto errors = errors_of(distance(plane, {source}), [&](std::uint32_t v) { return plane.length(source, v); });
    SCOPED_TRACE(::testing::Message() << "shear " << shear << ": " << errors.least << " " << errors.mean << " "
                                      << errors.most);
    EXPECT_GT(errors.least, -1e-6);
    EXPECT_LT(errors.most, 0.02);
    EXPECT_LT(errors.mean, 0.0005);
  }
}

// A polygon with corners on a circle: a fan, in which one vertex has all triangles.
TEST(Geodesic, OfAPolygonWithManyCornersTakesSeconds) {
  constexpr std::uint32_t kCorners = 200000;
  WholeComplex fan;
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    fan.coordinates.insert(fan.coordinates.end(), {std::cos(angle), std::sin(angle), 0});
    if (i >= 2) fan.triangles.push_back({0, i - 1, i});
  }
  const std::clock_t start = std::clock();  // processor time: it does not depend on other processes
  const auto d = distance(fan, {0});
  EXPECT_LT(std::clock() - start, 20 * CLOCKS_PER_SEC) << "usually a second or two";
  for (std::uint32_t v = 0; v < kCorners; ++v)
    ASSERT_NEAR(d[v], 2 * std::sin(std::numbers::pi * v / kCorners), 1e-6) << v;
}

TEST(Geodesic, OfSeveralSourcesInAPlane) {
  const WholeComplex plane = testing::random_plane(16, 3);
  const auto errors = errors_of(distance(plane, {0, 288}),
                                [&](std::uint32_t v) { return std::min(plane.length(0, v), plane.length(288, v)); });
  // Where both are as near, the virtual source is between them.
  EXPECT_GT(errors.least, -0.05);
  EXPECT_LT(errors.most, 0.05);
  EXPECT_LT(errors.mean, 0.01);
}

TEST(Geodesic, OnASphereTheErrorFallsWithTheEdge) {
  std::vector<Errors> errors;
  for (const unsigned levels : {3u, 4u, 5u, 6u}) {
    const WholeComplex sphere = testing::sphere(levels);
    errors.push_back(errors_of(distance(sphere, {5}), [&](std::uint32_t v) {
      double dot = 0;
      for (std::size_t k = 0; k < 3; ++k) dot += sphere.coordinates[15 + k] * sphere.coordinates[3 * v + k];
      return v == 5 ? 0 : std::acos(std::clamp(dot, -1.0, 1.0));
    }));
  }
  EXPECT_GT(errors[2].least, -0.008);
  EXPECT_LT(errors[2].mean, 0.002);
  EXPECT_LT(errors[2].most, 1e-4);
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i].mean, 0.55 * errors[i - 1].mean);
}

TEST(Geodesic, IsNeverLongerThanAlongEdges) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 300; ++round) {
    WholeComplex complex;
    const auto vertices = static_cast<std::uint32_t>(2 + random() % 20);
    for (std::uint32_t i = 0; i < 3 * vertices; ++i) complex.coordinates.push_back(static_cast<double>(random() % 100));
    const auto any = [&] { return static_cast<std::uint32_t>(random() % vertices); };
    for (std::uint32_t i = 0; i < vertices; ++i) {
      const std::uint32_t a = any(), b = any(), c = any();
      if (a != b && b != c && c != a)
        complex.triangles.push_back({a, b, c});
      else if (a != b)
        complex.edges.push_back({a, b});
    }
    const std::uint32_t source = any();
    const auto d = distance(complex, {source}), e = along_edges(complex, source);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      ASSERT_LE(d[v], e[v] * (1 + 1e-12));
      ASSERT_EQ(d[v] < kInfinite, e[v] < kInfinite);
      ASSERT_GE(d[v], 0);
    }
    complex.edges.insert(complex.edges.end(), {{0, 1}});
    for (const auto& t : complex.triangles)
      complex.edges.insert(complex.edges.end(), {{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}});
    complex.triangles.clear();
    const auto f = distance(complex, {source}), g = along_edges(complex, source);
    for (std::uint32_t v = 0; v < vertices; ++v)
      ASSERT_TRUE(f[v] == g[v] || std::abs(f[v] - g[v]) <= 1e-9 * (1 + g[v]));
  }
}

TEST(WholeComplex, ItemsHaveNumbersOf32Bits) {
  EXPECT_NO_THROW(require_numbers(0xFFFFFFFE, "triangles"));
  for (const std::uint64_t count : {std::uint64_t{0xFFFFFFFF}, std::uint64_t{1} << 32}) {
    try {
      require_numbers(count, "triangles");
      ADD_FAILURE() << count;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kResource);
      EXPECT_NE(error.message().find("triangles"), std::string::npos);
    }
  }
}

TEST(Geodesic, ItsMemoryIsReserved) {
  const WholeComplex plane = testing::random_plane(40, 1);
  MemoryBudget budget(50 << 10);
  EXPECT_THROW(geodesic_distance(plane, std::vector<std::uint32_t>{0}, budget), Error);
}

}  // namespace
}  // namespace reeb::io
