// Views, projections and the z-buffer, against the definition.
#include "io/drawing/surface_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "io/plot/view.h"

namespace reeb::io {
namespace {

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

TEST(View, IsOrthonormalAndUpright) {
  for (const Point& direction : {Point{1, 2, 3}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {1e200, 0, 1e-200}, {-1e-200, 0, 0}})
    for (const Point& upright : {Point{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}) {
      const View view = view_from(direction, upright);
      for (const Point& axis : {view.right, view.up, view.toward}) EXPECT_NEAR(dot(axis, axis), 1, 1e-12);
      EXPECT_NEAR(dot(view.right, view.up), 0, 1e-12);
      EXPECT_NEAR(dot(view.up, view.toward), 0, 1e-12);
      EXPECT_GE(dot(view.up, upright), -1e-12);
    }
}

TEST(View, OfAFlatShapeIsFromItsFront) {
  std::vector<Point> plate;
  for (double x = 0; x < 5; ++x)
    for (double y = 0; y < 5; ++y) plate.push_back({x, y, 7});
  EXPECT_EQ(best_view(plate, {}, {0, 1, 0}).toward, (Point{0, 0, 1}));
}

// The best of several directions shows the broad side.
TEST(View, OfAThickPlateShowsItsBroadSide) {
  std::vector<Point> plate;
  for (double x = 0; x < 20; ++x)
    for (double y = 0; y < 20; ++y)
      for (double z = 0; z < 2; ++z) plate.push_back({x, z, y});
  EXPECT_GT(std::abs(best_view(plate, {}, {0, 0, 1}).toward[1]), 0.8);
}

TEST(Projection, FillsItsBox) {
  std::mt19937_64 random(2);
  const auto number = [&] { return static_cast<double>(random() % 1000) / 10; };
  std::vector<Point> points;
  for (int i = 0; i < 100; ++i) points.push_back({number(), number(), number()});
  const Projection projection(view_from({1, 2, 1}, {0, 0, 1}), points, {20, 30}, 760, 640);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const Point& point : points) {
    const PicturePoint at = projection.place(point);
    left = std::min(left, at.x);
    right = std::max(right, at.x);
    top = std::min(top, at.y);
    bottom = std::max(bottom, at.y);
  }
  EXPECT_NEAR((left + right) / 2, 20 + 760 / 2, 1e-6);
  EXPECT_NEAR(top, 30, 1e-6);
  EXPECT_NEAR(bottom, 30 + projection.height(), 1e-6);
  EXPECT_TRUE(std::abs(right - left - 760) < 1e-6 || std::abs(projection.height() - 640) < 1e-6);
}

TEST(Projection, OfOnePointIsInTheMiddle) {
  const Projection projection(view_from({0, -1, 0}, {0, 0, 1}), std::vector<Point>{{5, 6, 7}}, {0, 0}, 760, 640);
  EXPECT_EQ(projection.place({5, 6, 7}).x, 380);
  EXPECT_EQ(projection.pixels_per_unit(), 0);
}

// The number of triangles in front of a point, one triangle at a time.
TEST(SurfaceRaster, CountsTheLayersInFront) {
  constexpr double kSide = 40;
  std::mt19937_64 random(8);
  const auto number = [&](double most) {
    return static_cast<float>(static_cast<double>(random() % 100000) / 1e5 * most);
  };
  std::vector<Probe> probes;
  for (int i = 0; i < 300; ++i)  // in the middle of samples: two of them are a pixel
    probes.push_back({std::floor(number(kSide * 2 - 1)) / 2, std::floor(number(kSide * 2 - 1)) / 2, number(10)});
  SurfaceRaster raster(kSide, kSide, 1, SurfaceStyle::kGlass, probes);
  std::vector<unsigned> expected(probes.size(), 0);
  for (int i = 0; i < 200; ++i) {
    std::array<SurfacePoint, 3> t;
    for (SurfacePoint& corner : t) corner = {number(kSide), number(kSide), number(10), 0};
    raster.triangle(t, true);
    for (std::size_t k = 0; k < probes.size(); ++k) {
      // Barycentric coordinates by areas.
      const auto area = [](double ax, double ay, double bx, double by, double cx, double cy) {
        return (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
      };
      const double all = area(t[0].x, t[0].y, t[1].x, t[1].y, t[2].x, t[2].y), x = probes[k].x, y = probes[k].y;
      const double a = area(x, y, t[1].x, t[1].y, t[2].x, t[2].y) / all,
                   b = area(t[0].x, t[0].y, x, y, t[2].x, t[2].y) / all;
      if (a < 0 || b < 0 || a + b > 1) continue;
      if (a * t[0].depth + b * t[1].depth + (1 - a - b) * t[2].depth > probes[k].depth) ++expected[k];
    }
  }
  unsigned total = 0;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    EXPECT_EQ(raster.layers()[k], expected[k]) << k;
    total += expected[k];
  }
  EXPECT_GT(total, 500u);
}

std::array<SurfacePoint, 3> covering(float depth, float value) {
  return {{{-100, -100, depth, value}, {300, -100, depth, value}, {-100, 300, depth, value}}};
}

TEST(SurfaceRaster, ShowsTheNearestInAnyOrder) {
  for (const bool near_first : {false, true}) {
    SurfaceRaster raster(20, 20, 1, SurfaceStyle::kValue, {});
    raster.triangle(covering(near_first ? 2 : 1, near_first ? 1 : 0), true);
    raster.triangle(covering(near_first ? 1 : 2, near_first ? 0 : 1), true);
    const Rgb seen = raster.image().pixels[10 * 20 + 10];
    EXPECT_GT(seen.red, seen.blue + 80) << "yellow is high, violet is low";
  }
}

TEST(SurfaceRaster, IgnoresTrianglesThatAreNowhere) {
  SurfaceRaster raster(20, 20, 1, SurfaceStyle::kSolid, {});
  const float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
  raster.triangle({{{1, 1, 0, 0}, {1, 1, 0, 0}, {1, 1, 0, 0}}}, true);
  raster.triangle({{{-5, 1, 0, 0}, {-4, 9, 0, 0}, {-9, 3, 0, 0}}}, true);
  raster.triangle({{{1, 1, 0, 0}, {infinite, 1, 0, 0}, {1, infinite, 0, 0}}}, true);
  raster.triangle({{{1, 1, 0, 0}, {none, 1, 0, 0}, {1, 9, none, 0}}}, true);
  for (const Rgb& pixel : raster.image().pixels) EXPECT_EQ(pixel, kPaper);
}

// At some angle to the light the brightest colour is as bright as it can be.
TEST(SurfaceRaster, TheGreatestValueIsYellowAtAnyAngle) {
  for (float right = -40; right <= 40; right += 5)
    for (float down = -40; down <= 40; down += 5) {
      SurfaceRaster raster(20, 20, 1, SurfaceStyle::kValue, {});
      raster.triangle({{{-20, -10, -right - down, 1}, {60, -10, 3 * right - down, 1}, {-20, 70, 3 * down - right, 1}}},
                      true);
      const Raster image = raster.image();
      const Rgb middle = image.pixels[10 * image.width + 10];
      EXPECT_GT(middle.red, 90) << right << ' ' << down;
      EXPECT_GT(middle.red, middle.green);
      EXPECT_GT(middle.green, 2 * middle.blue);
    }
}

}  // namespace
}  // namespace reeb::io
