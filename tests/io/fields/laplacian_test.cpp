// Eigenvectors against closed forms, and against a dense solution of the generalized problem.
#include "io/fields/laplacian.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "libreeb/base/error.h"
#include "tests/io/fields/made_surfaces.h"

namespace reeb::io {
namespace {

Eigenvector eigenvector(const WholeComplex& complex, std::uint64_t k) {
  MemoryBudget budget;
  return laplacian_eigenvector(complex, k, budget);
}

// The sign of an eigenvector is free; docs/CLI.md chooses it.
void expect_largest_entry_positive(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  EXPECT_GE(most, -least);
}

WholeComplex path(std::uint32_t vertices) {
  WholeComplex complex;
  complex.is_surface = false;
  for (std::uint32_t i = 0; i < vertices; ++i)
    complex.coordinates.insert(complex.coordinates.end(), {1.0 * i * i, 0, 0});
  for (std::uint32_t i = 1; i < vertices; ++i) complex.edges.push_back({i - 1, i});
  return complex;
}

TEST(Laplacian, OfAPathIsCosines) {
  for (const std::uint32_t vertices : {2u, 3u, 10u, 500u}) {
    const WholeComplex line = path(vertices);
    for (std::uint64_t k = 1; k < std::min(vertices, 6u); ++k) {
      const auto u = eigenvector(line, k);
      const double angle = std::numbers::pi * static_cast<double>(k) / vertices;
      EXPECT_NEAR(u.eigenvalue, 2 - 2 * std::cos(angle), 1e-10);
      for (std::uint32_t i = 0; i < vertices; ++i)
        ASSERT_NEAR(std::abs(u.values[i]), std::abs(std::sqrt(2.0 / vertices) * std::cos(angle * (i + 0.5))), 1e-6);
      expect_largest_entry_positive(u.values);
    }
  }
}

TEST(Laplacian, OfASphereIsL_LPlus1) {
  const WholeComplex sphere = testing::sphere(4);
  for (std::uint64_t k = 1; k <= 15; ++k) {
    const auto u = eigenvector(sphere, k);
    const double exact = k <= 3 ? 2 : k <= 8 ? 6 : 12;
    EXPECT_NEAR(u.eigenvalue, exact, 0.01 * exact) << k;
    EXPECT_LT(u.residual, 1e-8) << k;
  }
}

TEST(Laplacian, OfAFlatTorusIsSquares) {
  const WholeComplex torus = testing::flat_torus(40);
  const double exact[] = {1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4, 4};
  for (std::uint64_t k = 1; k <= 12; ++k) {
    const auto u = eigenvector(torus, k);
    EXPECT_NEAR(u.eigenvalue, exact[k - 1], 0.02 * exact[k - 1]) << k;
    EXPECT_LT(u.residual, 1e-8) << k;
  }
}

// The matrices from the definition, dense: cotangents by angles, areas by cross products.
TEST(Laplacian, IsThatOfTheDenseProblem) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const WholeComplex plane = testing::random_plane(14, seed);
    const auto n = static_cast<Eigen::Index>(plane.vertex_count());
    Eigen::MatrixXd l = Eigen::MatrixXd::Zero(n, n), m = Eigen::MatrixXd::Zero(n, n);
    const auto point = [&](std::uint32_t v) {
      return Eigen::Vector3d(plane.coordinates[3 * v], plane.coordinates[3 * v + 1], plane.coordinates[3 * v + 2]);
    };
    for (const auto& t : plane.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t p = t[i], q = t[(i + 1) % 3], r = t[(i + 2) % 3];
        const Eigen::Vector3d u = point(q) - point(p), w = point(r) - point(p);
        const double half = 0.5 / std::tan(std::acos(u.dot(w) / u.norm() / w.norm()));
        l(q, r) -= half, l(r, q) -= half, l(q, q) += half, l(r, r) += half;
        m(p, p) += u.cross(w).norm() / 6;
      }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(l, m);
    for (std::uint64_t k = 1; k <= 8; ++k) {
      const auto u = eigenvector(plane, k);
      const auto place = static_cast<Eigen::Index>(k);
      EXPECT_NEAR(u.eigenvalue, solver.eigenvalues()[place], 1e-9);
      const Eigen::VectorXd expected = solver.eigenvectors().col(place);
      const Eigen::Map<const Eigen::VectorXd> values(u.values.data(), n);
      EXPECT_LT(std::min((values - expected).norm(), (values + expected).norm()), 1e-5 * expected.norm()) << k;
      expect_largest_entry_positive(u.values);
    }
  }
}

TEST(Laplacian, OtherComponentsAreZeroAndCounted) {
  WholeComplex two = path(200);
  two.coordinates.insert(two.coordinates.end(), {0, 1, 0, 0, 2, 0, 0, 3, 0});
  two.edges.push_back({200, 201});
  const auto u = eigenvector(two, 1);
  EXPECT_EQ(u.other_vertices, 3u);
  for (std::size_t v = 200; v < 203; ++v) EXPECT_EQ(u.values[v], 0);
  EXPECT_NE(u.values[0], 0);
}

TEST(Laplacian, IsTheSameAtEveryScale) {
  // Solved densely, and by Lanczos.
  for (const unsigned levels : {1u, 3u}) {
    const auto expected = eigenvector(testing::sphere(levels), 4);
    for (const double scale : {1e-150, 1e-90, 1e-8, 1e-3, 1e8, 1e90, 1e150}) {
      WholeComplex sphere = testing::sphere(levels);
      for (double& x : sphere.coordinates) x *= scale;
      use_unit_of_edges(sphere);
      const auto u = eigenvector(sphere, 4);
      EXPECT_NEAR(u.eigenvalue * scale * scale / expected.eigenvalue, 1, 1e-6) << scale;
      EXPECT_LT(u.residual, 1e-6) << scale;
    }
  }
}

// A square of 12 cells a side, and a vertex in the middle of one edge, which only one of its triangles has. `closed`: a
// triangle without area closes the gap.
WholeComplex plane_with_junction(bool closed) {
  constexpr std::uint32_t kCells = 12;
  WholeComplex plane;
  for (std::uint32_t y = 0; y <= kCells; ++y)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      plane.coordinates.insert(plane.coordinates.end(), {1.5 * x, 1.0 * y, 0});
  const auto middle = plane.vertex_count();
  plane.coordinates.insert(plane.coordinates.end(), {1.5 * 5.5, 4, 0});
  for (std::uint32_t y = 0; y < kCells; ++y)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t a = y * (kCells + 1) + x, b = a + 1, c = a + kCells + 1, d = c + 1;
      plane.triangles.push_back({a, d, c});
      if (x == 5 && y == 4) {
        plane.triangles.insert(plane.triangles.end(), {{a, middle, d}, {middle, b, d}});
        if (closed) plane.triangles.push_back({a, b, middle});
      } else {
        plane.triangles.push_back({a, b, d});
      }
    }
  return plane;
}

// The square has the eigenvalues of cosines; a gap that is not closed lowers them.
TEST(Laplacian, ATriangleWithoutAreaJoinsItsNeighbours) {
  const double exact = std::pow(std::numbers::pi / (1.5 * 12), 2);
  for (const double lift : {0.0, 1e-9, 1e-6, 1e-3}) {
    WholeComplex plane = plane_with_junction(true);
    plane.coordinates[plane.coordinates.size() - 2] += lift;
    const auto u = eigenvector(plane, 1);
    EXPECT_NEAR(u.eigenvalue, exact, 0.01 * exact) << lift;
    EXPECT_LT(u.residual, 1e-6) << lift;
  }
}

TEST(Laplacian, RepeatedSimplicesChangeNothing) {
  const auto expected = eigenvector(testing::random_plane(14, 1), 3);
  WholeComplex plane = testing::random_plane(14, 1);
  const auto [a, b, c] = plane.triangles[7];
  plane.triangles.push_back({c, a, b});
  plane.triangles.push_back({b, a, c});
  plane.edges = {{b, c}, {c, b}, {a, b}};
  // Another component, of an edge.
  const std::uint32_t more = plane.vertex_count();
  plane.coordinates.insert(plane.coordinates.end(), {0, 0, 1, 0, 0, 2});
  plane.edges.push_back({more, more + 1});
  plane.is_surface = false;
  auto u = eigenvector(plane, 3);
  u.values.resize(more);
  EXPECT_EQ(u.values, expected.values);
  EXPECT_EQ(u.eigenvalue, expected.eigenvalue);
  // An edge that no triangle has makes it a graph.
  plane.edges.push_back({0, 14});
  EXPECT_NE(eigenvector(plane, 3).eigenvalue, expected.eigenvalue);
}

TEST(Laplacian, RefusesWhatIsNotThere) {
  MemoryBudget budget;
  EXPECT_THROW(laplacian_eigenvector(path(5), 5, budget), Error);
  EXPECT_NO_THROW(laplacian_eigenvector(path(5), 4, budget));
  EXPECT_THROW(laplacian_eigenvector(WholeComplex(), 1, budget), Error);
  WholeComplex flat = testing::random_plane(3, 1);
  std::ranges::fill(flat.coordinates, 1.0);
  EXPECT_THROW(laplacian_eigenvector(flat, 1, budget), Error);
  MemoryBudget small(1 << 20);
  try {
    laplacian_eigenvector(testing::sphere(5), 1, small);
    ADD_FAILURE() << "fits";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
  }
}

// Half of the eigenvectors: the method holds two matrices of 441 rows and columns.
TEST(Laplacian, TheMemoryOfTheDenseMethodIsReserved) {
  const WholeComplex plane = testing::random_plane(20, 1);
  MemoryBudget small(2 << 20), enough(5 << 20);
  try {
    laplacian_eigenvector(plane, 220, small);
    ADD_FAILURE() << "fits";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
  }
  EXPECT_NO_THROW(laplacian_eigenvector(plane, 220, enough));
  EXPECT_GE(enough.peak_bytes(), 16u * 441 * 441);
}

}  // namespace
}  // namespace reeb::io
