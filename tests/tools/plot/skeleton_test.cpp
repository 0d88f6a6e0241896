// Radii and points on the surface, of shapes whose contours are known; and the files of earlier versions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/data.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using Point = std::array<double, 3>;

struct Sample {
  Point place;
  double radius;
};

class Skeleton : public ProgramTest {
 protected:
  // Writes a mesh with the vertices of a grid of rows and columns, the columns closed to a ring, and also the rows if
  // `closed`.
  void write_rings(int rows, int columns, bool closed, const std::function<Point(double row, double angle)>& place) {
    std::ostringstream out;
    out.precision(17);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const Point p = place(row, 2 * std::numbers::pi * column / columns);
        vertices_.push_back(p);
        out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      }
    const auto at = [&](int row, int column) { return row % rows * columns + column % columns + 1; };
    for (int row = 0; row + (closed ? 0 : 1) < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        out << "f " << at(row, column) << ' ' << at(row, column + 1) << ' ' << at(row + 1, column) << '\n';
        out << "f " << at(row + 1, column) << ' ' << at(row, column + 1) << ' ' << at(row + 1, column + 1) << '\n';
      }
    write("mesh.obj", out.str());
  }

  std::vector<Sample> samples(const std::vector<std::string>& options = {}) {
    expect_success(reeb({"mesh.obj", "-o", "g.reeb", "--quiet", "--force"}));
    std::vector<std::string> words{"extract", "g.reeb", "-o", "g.swc", "--force", "--threshold", "5%"};
    words.insert(words.end(), options.begin(), options.end());
    expect_success(reeb(words));
    std::istringstream lines(file("g.swc"));
    std::vector<Sample> found;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#')) continue;
      std::istringstream words_of(line);
      Sample sample;
      int number = 0, type = 0;
      words_of >> number >> type >> sample.place[0] >> sample.place[1] >> sample.place[2] >> sample.radius;
      found.push_back(sample);
    }
    return found;
  }

  // Radii are within 2 % of what `expected` says. Those of which it says at most `least` do not count.
  static void expect_radii(const std::vector<Sample>& found, const std::function<double(const Point&)>& expected,
                           double least = 0) {
    int count = 0;
    for (const Sample& sample : found) {
      const double radius = expected(sample.place);
      if (radius <= least) continue;
      ++count;
      EXPECT_NEAR(sample.radius, radius, 0.02 * radius)
          << sample.place[0] << ' ' << sample.place[1] << ' ' << sample.place[2];
    }
    EXPECT_GT(count, 20);
  }

  std::vector<Point> vertices_;
};

TEST_F(Skeleton, ACylinderHasItsRadiusAlongAllOfIt) {
  write_rings(200, 48, false, [](double row, double angle) {
    return Point{100 + 2 * std::cos(angle), 2 * std::sin(angle), row / 10};
  });
  expect_radii(samples(), [](const Point&) { return 2.0; });
}

// A bucket is about as long as the cylinder is wide.
TEST_F(Skeleton, ASlenderCylinderHasItsRadius) {
  write_rings(4000, 12, false, [](double row, double angle) {
    return Point{std::cos(angle), std::sin(angle), row / 20};
  });
  expect_radii(samples(), [](const Point&) { return 1.0; });
}

TEST_F(Skeleton, AConeHasItsRadii) {
  write_rings(300, 48, false, [](double row, double angle) {
    const double radius = row / 100;
    return Point{radius * std::cos(angle), radius * std::sin(angle), row / 30};
  });
  expect_radii(
      samples(), [](const Point& p) { return p[2] > 0 ? 0.3 * p[2] : 0; }, 0.13);
}

// The contours of a torus on a plane, at the height z, are two circles around its axis.
TEST_F(Skeleton, ALyingTorusHasTheRadiiOfItsContours) {
  write_rings(256, 128, true, [](double row, double angle) {
    const double around = 2 * std::numbers::pi * row / 256, radius = 4 + std::cos(angle);
    return Point{radius * std::cos(around), radius * std::sin(around), std::sin(angle)};
  });
  int inner = 0, outer = 0;
  for (const Sample& sample : samples()) {
    const double z = sample.place[2];
    if (std::abs(z) > 0.9 || std::hypot(sample.place[0], sample.place[1]) > 0.1) continue;
    const double step = std::sqrt(1 - z * z);
    const bool is_inner = sample.radius < 4;
    ++(is_inner ? inner : outer);
    EXPECT_NEAR(sample.radius, is_inner ? 4 - step : 4 + step, 0.02 * sample.radius) << z;
  }
  EXPECT_GT(inner, 20);
  EXPECT_GT(outer, 20);
}

// At the height of the axis a standing torus is cut across its tube.
TEST_F(Skeleton, AStandingTorusHasTheRadiusOfItsTube) {
  write_rings(256, 64, true, [](double row, double angle) {
    const double around = 2 * std::numbers::pi * row / 256, radius = 4 + std::cos(angle);
    return Point{radius * std::cos(around), std::sin(angle), radius * std::sin(around)};
  });
  int count = 0;
  for (const Sample& sample : samples()) {
    if (std::abs(sample.place[2]) > 0.15) continue;
    ++count;
    EXPECT_NEAR(sample.radius, 1, 0.02);
  }
  EXPECT_GT(count, 3);
}

// Radii and rims are single precision there.
TEST_F(Skeleton, IsFiniteForAllFiniteCoordinates) {
  for (const double scale : {1e38, 1e39, 1e160, 1.5e307, 1.6e308}) {
    const double height = std::min(scale, 8e307);  // the range of f is a number
    vertices_.clear();
    write_rings(24, 16, true, [&](double row, double angle) {
      const double around = 2 * std::numbers::pi * row / 24, radius = 0.75 + 0.25 * std::cos(angle);
      return Point{scale * radius * std::cos(around), std::sin(angle), height * radius * std::sin(around)};
    });
    const std::vector<Sample> found = samples();
    EXPECT_FALSE(found.empty()) << scale;
    for (const Sample& sample : found) {
      for (const double x : sample.place) EXPECT_TRUE(std::isfinite(x)) << scale;
      EXPECT_TRUE(std::isfinite(sample.radius)) << scale;
    }
    expect_success(reeb({"verify", "g.reeb", "--mesh", "mesh.obj", "--full"}));
    for (const char* format : {"json", "gltf"})
      for (const char* threshold : {"0", "60%"}) {
        const Outcome outcome = reeb({"extract", "g.reeb", "--threshold", threshold, "--format", format});
        expect_success(outcome);
        EXPECT_TRUE(nlohmann::json::accept(outcome.output)) << scale << ' ' << last_command();
      }
    for (const char* part : {"1/2", "2/2"})
      expect_success(reeb({"fragment", "mesh.obj", "--part", part, "--quiet", "--force", "-o",
                           std::string("part") + part[0] + ".fragment"}));
    expect_success(reeb({"glue", "part1.fragment", "part2.fragment", "-o", "glued.reeb", "--force"}));
    expect_success(reeb({"verify", "glued.reeb"}));
  }
}

TEST_F(Skeleton, OnTheSurfaceEverySampleIsAVertex) {
  write_rings(64, 96, true, [](double row, double angle) {
    const double around = 2 * std::numbers::pi * row / 64, radius = 4 + std::cos(angle);
    return Point{radius * std::cos(around), std::sin(angle), 50 + radius * std::sin(around)};
  });
  const auto is_vertex = [&](const Point& p) {
    for (const Point& v : vertices_)
      if (std::abs(p[0] - v[0]) + std::abs(p[1] - v[1]) + std::abs(p[2] - v[2]) < 1e-5) return true;
    return false;
  };
  int inside = 0;
  for (const Sample& sample : samples()) inside += is_vertex(sample.place) ? 0 : 1;
  EXPECT_GT(inside, 50);
  const std::vector<Sample> on_surface = samples({"--on-surface"});
  EXPECT_GT(on_surface.size(), 50u);
  for (const Sample& sample : on_surface) EXPECT_TRUE(is_vertex(sample.place));
  expect_error(reeb({"extract", "g.reeb", "--on-surface", "--format", "dot"}), 2, "--on-surface is for formats");
}

// The mean of a contour of a hill lies inside the hill.
TEST_F(Skeleton, OnATerrainLinesRunOnTheGround) {
  constexpr int kSide = 80;
  const auto height = [](double x, double y) { return 3 * std::sin(x / 9) * std::cos(y / 11) + x / 50; };
  std::ostringstream out;
  out.precision(17);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) out << "v " << x << ' ' << y << ' ' << height(x, y) << '\n';
  for (int y = 0; y + 1 < kSide; ++y)
    for (int x = 0; x + 1 < kSide; ++x) {
      const int a = y * kSide + x + 1, b = a + kSide;
      out << "f " << a << ' ' << a + 1 << ' ' << b << "\nf " << b << ' ' << a + 1 << ' ' << b + 1 << '\n';
    }
  write("mesh.obj", out.str());
  const auto most_above_ground = [&](const std::vector<Sample>& found) {
    double most = 0;
    for (const Sample& sample : found)
      most = std::max(most, std::abs(sample.place[2] - height(sample.place[0], sample.place[1])));
    return most;
  };
  EXPECT_GT(most_above_ground(samples()), 0.5);
  const std::vector<Sample> on_surface = samples({"--on-surface"});
  EXPECT_GT(on_surface.size(), 100u);
  EXPECT_LT(most_above_ground(on_surface), 1e-4);

  expect_success(reeb({"plot", "g.reeb", "--kind", "skeleton", "-o", "inside.svg"}));
  expect_success(reeb({"plot", "g.reeb", "--kind", "skeleton", "--on-surface", "-o", "ground.svg"}));
  EXPECT_NE(file("inside.svg"), file("ground.svg"));
  expect_error(reeb({"plot", "g.reeb", "--on-surface", "-o", "x.svg"}), 2, "--on-surface is for --kind skeleton");
  expect_success(reeb({"mesh.obj", "-o", "plain.reeb", "--buckets", "0", "--quiet"}));
  expect_error(reeb({"extract", "plain.reeb", "--on-surface", "--format", "obj"}), 1,
               "plain.reeb: this file has no points of the surface");
}

// A file of each version of the format, with what it had when it was written.
TEST_F(Skeleton, FilesOfEarlierVersionsAreRead) {
  for (const std::string name : {"version-1", "version-2"}) {
    const std::string golden = REEB_SOURCE_DIR "/tests/golden/reeb/" + name;
    expect_success(reeb({"verify", golden + ".reeb"}));
    EXPECT_EQ(reeb({"extract", golden + ".reeb"}).output, read_file(golden + ".rg"));
    const auto info = nlohmann::json::parse(reeb({"info", golden + ".reeb", "--json"}).output);
    EXPECT_GT(info.at("embedding").at("buckets").get<int>(), 20);
    for (const auto& level : info.at("levels"))
      EXPECT_EQ(
          level.at("memory_bytes").get<int>(),
          48 * level.at("nodes").get<int>() + 24 * level.at("arcs").get<int>() + 56 * level.at("buckets").get<int>());
  }
  const std::string old = REEB_SOURCE_DIR "/tests/golden/reeb/version-1.reeb";
  const Outcome swc = reeb({"extract", old, "--format", "swc"});
  expect_success(swc);
  EXPECT_NE(unwrapped(swc.error).find("written by an earlier version"), std::string::npos) << swc.error;
  expect_error(reeb({"extract", old, "--format", "vtp", "--on-surface"}), 1, old + ": this file was written by an");
  EXPECT_EQ(reeb({"extract", old, "--format", "vtp"}).output.find("Radius"), std::string::npos);
}

TEST_F(Skeleton, AFileWithoutBucketsHasTheFormerVersion) {
  write("mesh.obj", "v 0 0 0\nv 1 0 1\nv 0 1 2\nf 1 2 3\n");
  expect_success(reeb({"mesh.obj", "-o", "plain.reeb", "--buckets", "0"}));
  expect_success(reeb({"mesh.obj", "-o", "embedded.reeb"}));
  EXPECT_EQ(file("plain.reeb")[8], 1);
  EXPECT_EQ(file("embedded.reeb")[8], 2);
  std::string other = file("embedded.reeb");
  other[8] = 3;
  write("other.reeb", other);
  expect_error(reeb({"info", "other.reeb"}), 1,
               "other.reeb:8: the format version is 3, and this program reads 1 and 2");
}

}  // namespace
}  // namespace reeb::test
