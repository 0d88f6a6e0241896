#include "io/generate/surfaces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include "io/generate/grid_surface.h"
#include "io/generate/noise.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

using Closing = GridLayout::Closing;

float coordinate(std::uint64_t x) { return static_cast<float>(x); }
float coordinate(double x) { return static_cast<float>(x); }

double longest_wave(const GridLayout& layout) { return static_cast<double>(std::max(layout.width, layout.height)) / 2; }

// Stands on its side, with the circle of rings upright: z has one minimum, two saddles, one maximum.
class Torus : public GridSurface {
 public:
  using GridSurface::GridSurface;

 private:
  static double angle(std::uint64_t step, std::uint64_t steps) {
    // Rotated by a quarter step, so that no vertex has a mirror image at the same height.
    return 2 * std::numbers::pi * (static_cast<double>(step) + 0.25) / static_cast<double>(steps);
  }
  std::array<Point, 2> place(GridPoint p) const override {
    const double around_ring = angle(p.i, layout().width), ring = angle(p.j, layout().height);
    const double radius = 1.0 + 0.5 * std::cos(around_ring);
    return {{{coordinate(radius * std::cos(ring)), coordinate(0.5 * std::sin(around_ring)),
              coordinate(radius * std::sin(ring))},
             {}}};
  }
};

class Terrain : public GridSurface {
 public:
  using GridSurface::GridSurface;

 private:
  static constexpr double kSlope = 0.3, kShortestWave = 6, kRoughness = 0.1;

  std::array<Point, 2> place(GridPoint p) const override {
    const double z = fractal_noise(layout().seed, static_cast<double>(p.i), static_cast<double>(p.j),
                                   longest_wave(layout()), kShortestWave, kSlope) +
                     kRoughness * white_noise(layout().seed, p.i, p.j);
    return {{{coordinate(p.i), coordinate(p.j), coordinate(z)}, {}}};
  }
};

class FlatGrid : public GridSurface {
 public:
  using GridSurface::GridSurface;

 private:
  std::array<Point, 2> place(GridPoint p) const override { return {{{coordinate(p.i), coordinate(p.j), 0}, {}}}; }
};

class Plate : public GridSurface {
 public:
  using GridSurface::GridSurface;

 private:
  std::array<Point, 2> place(GridPoint p) const override {
    return {{{coordinate(p.i), coordinate(p.j), 1}, {coordinate(p.i), coordinate(p.j), 0}}};
  }
};

// Both sheets follow one rolling shape; measurement noise is independent in every coordinate.
class Scan : public GridSurface {
 public:
  using GridSurface::GridSurface;

 private:
  static constexpr double kSlope = 0.35, kShortestWave = 8, kHalfThickness = 1.5, kNoise = 0.15;

  std::array<Point, 2> place(GridPoint p) const override {
    const double z = fractal_noise(layout().seed, static_cast<double>(p.i), static_cast<double>(p.j),
                                   longest_wave(layout()), kShortestWave, kSlope);
    return {noisy(p, z + kHalfThickness, mix(layout().seed)), noisy(p, z - kHalfThickness, ~mix(layout().seed))};
  }
  static Point noisy(GridPoint p, double z, std::uint64_t seed) {
    return {coordinate(static_cast<double>(p.i) + kNoise * white_noise(seed + 1, p.i, p.j)),
            coordinate(static_cast<double>(p.j) + kNoise * white_noise(seed + 2, p.i, p.j)),
            coordinate(z + kNoise * white_noise(seed + 3, p.i, p.j))};
  }
};

Closing closing_of(MeshKind kind) {
  if (kind == MeshKind::kTorus) return Closing::kTorus;
  return kind == MeshKind::kPlate || kind == MeshKind::kScan ? Closing::kTwoSheets : Closing::kDisc;
}

// Small handles everywhere: one per 64 x 64 cells, more on small meshes.
HoleLayout scattered_holes(std::uint64_t width, std::uint64_t height) {
  const auto quarter = static_cast<int>(std::bit_width(std::min(width, height) / 4)) - 1;
  return {static_cast<unsigned>(std::clamp(quarter, 2, 6)), true};
}

// The height that brings the triangle count of `layout` nearest to `triangles`.
std::uint64_t nearest_height(GridLayout layout, std::uint64_t min_height, std::uint64_t triangles) {
  const auto count = [&layout](std::uint64_t height) {
    layout.height = height;
    return triangle_count(layout);
  };
  std::uint64_t low = min_height, high = std::max(min_height, triangles / layout.width + 1);
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (count(middle) < triangles)
      low = middle + 1;
    else
      high = middle;
  }
  const bool below_is_nearer =
      low > min_height && triangles - count(low - 1) < count(low) - std::min(triangles, count(low));
  return below_is_nearer ? low - 1 : low;
}

GridLayout layout_of(const GeneratorOptions& options) {
  GridLayout layout;
  layout.closing = closing_of(options.kind);
  layout.order = options.order;
  layout.tile_cells = options.tile_cells;
  layout.seed = mix(options.seed);
  const std::uint64_t min_side = layout.closing == Closing::kTorus ? 3 : 1;
  const std::uint64_t cells = options.triangles / (layout.closing == Closing::kTwoSheets ? 4 : 2);
  const auto side = static_cast<std::uint64_t>(std::lround(std::sqrt(static_cast<double>(cells))));
  layout.width = options.width.value_or(std::max(side, min_side));
  if (layout.width < min_side || layout.width > options.triangles + min_side)
    throw Error(ErrorKind::kUsage, "a row of " + std::to_string(layout.width) + " cells does not fit the mesh",
                "choose --width between " + std::to_string(min_side) + " and the number of triangles");
  if (options.kind == MeshKind::kScan) layout.holes = scattered_holes(layout.width, cells / layout.width);
  layout.height = nearest_height(layout, min_side, options.triangles);
  return layout;
}

}  // namespace

std::unique_ptr<Shape> make_grid_surface(const GeneratorOptions& options) {
  const GridLayout layout = layout_of(options);
  switch (options.kind) {
    case MeshKind::kTorus:
      return std::make_unique<Torus>(layout);
    case MeshKind::kTerrain:
      return std::make_unique<Terrain>(layout);
    case MeshKind::kPlate:
      return std::make_unique<Plate>(layout);
    case MeshKind::kScan:
      return std::make_unique<Scan>(layout);
    case MeshKind::kGrid:
    case MeshKind::kSierpinski:
    case MeshKind::kBall:
      break;
  }
  return std::make_unique<FlatGrid>(layout);
}

}  // namespace reeb::io
