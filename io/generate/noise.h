// Value noise: smooth random fields that need no table.
#pragma once

#include <cmath>
#include <cstdint>

#include "libreeb/base/hash.h"

namespace reeb::io {

constexpr std::uint64_t hash_of(std::uint64_t seed, std::uint64_t x, std::uint64_t y) {
  return mix(seed ^ (x * 0x9e3779b97f4a7c15u) ^ (y * 0xc2b2ae3d27d4eb4fu));
}

// Uniform in [-1, 1), independent from point to point.
constexpr double white_noise(std::uint64_t seed, std::uint64_t x, std::uint64_t y) {
  return static_cast<double>(hash_of(seed, x, y) >> 11) * 0x1p-52 - 1.0;
}

// White noise on the integer points, interpolated in between with continuous slope.
// REQUIRES: x, y >= 0.
inline double value_noise(std::uint64_t seed, double x, double y) {
  const auto ix = static_cast<std::uint64_t>(x), iy = static_cast<std::uint64_t>(y);
  const double tx = x - static_cast<double>(ix), ty = y - static_cast<double>(iy);
  const double sx = tx * tx * (3 - 2 * tx), sy = ty * ty * (3 - 2 * ty);
  const double low = std::lerp(white_noise(seed, ix, iy), white_noise(seed, ix + 1, iy), sx);
  const double high = std::lerp(white_noise(seed, ix, iy + 1), white_noise(seed, ix + 1, iy + 1), sx);
  return std::lerp(low, high, sy);
}

// Octaves of value noise, with wavelengths from `longest` down to `shortest`, each a quarter of the one before. Every
// octave has slopes of about `slope`.
inline double fractal_noise(std::uint64_t seed, double x, double y, double longest, double shortest, double slope) {
  double sum = 0;
  for (double length = longest; length >= shortest; length /= 4)
    sum += slope * length * value_noise(++seed, x / length, y / length);
  return sum;
}

}  // namespace reeb::io
