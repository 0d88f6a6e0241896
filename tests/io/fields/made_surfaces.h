// Surfaces with closed forms, for the tests of fields.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "io/fields/whole_complex.h"

namespace reeb::io::testing {

// A square of side `cells`, its inner vertices moved at random, each cell divided along a random diagonal.
inline WholeComplex random_plane(std::uint32_t cells, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shake(-0.3, 0.3);
  WholeComplex complex;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) {
      const bool inner_x = x != 0 && x != cells, inner_y = y != 0 && y != cells;
      complex.coordinates.insert(complex.coordinates.end(),
                                 {x + (inner_x ? shake(random) : 0), y + (inner_y ? shake(random) : 0), 0});
    }
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      if (random() % 2 == 0)
        complex.triangles.insert(complex.triangles.end(), {{a, b, d}, {a, d, c}});
      else
        complex.triangles.insert(complex.triangles.end(), {{a, b, c}, {b, d, c}});
    }
  return complex;
}

// The unit sphere: an icosahedron whose triangles are divided in four, `levels` times.
inline WholeComplex sphere(unsigned levels) {
  WholeComplex complex;
  const double g = std::numbers::phi;
  const auto add = [&](double x, double y, double z) {
    const double r = std::sqrt(x * x + y * y + z * z);
    complex.coordinates.insert(complex.coordinates.end(), {x / r, y / r, z / r});
  };
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g}) add(0, s, t), add(s, t, 0), add(t, 0, s);
  // The corners of a face of an icosahedron are as near as any.
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c)
        if (complex.length(a, b) < 1.1 && complex.length(b, c) < 1.1 && complex.length(a, c) < 1.1)
          complex.triangles.push_back({a, b, c});
  for (unsigned level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, complex.vertex_count());
      if (is_new) {
        std::array<double, 3> sum{};
        for (std::size_t k = 0; k < 3; ++k) sum[k] = complex.coordinates[3 * a + k] + complex.coordinates[3 * b + k];
        add(sum[0], sum[1], sum[2]);
      }
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : complex.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    complex.triangles = std::move(finer);
  }
  return complex;
}

// The product of two unit circles in four dimensions: a torus without curvature.
inline WholeComplex flat_torus(std::uint32_t side) {
  WholeComplex complex;
  complex.dimension = 4;
  for (std::uint32_t j = 0; j < side; ++j)
    for (std::uint32_t i = 0; i < side; ++i) {
      const double u = 2 * std::numbers::pi * i / side, v = 2 * std::numbers::pi * j / side;
      complex.coordinates.insert(complex.coordinates.end(), {std::cos(u), std::sin(u), std::cos(v), std::sin(v)});
      const std::uint32_t right = (i + 1) % side, up = (j + 1) % side;
      complex.triangles.insert(complex.triangles.end(), {{j * side + i, j * side + right, up * side + right},
                                                         {j * side + i, up * side + right, up * side + i}});
    }
  return complex;
}

}  // namespace reeb::io::testing
