// Areas and shortest contours of arcs against the definition, on small complexes: between two vertices that follow each
// other in the total order, each contour is measured triangle by triangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "libreeb/segmentation/chain_measures.h"
#include "ooc/run/segment.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/inputs/shapes.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

using Point = std::array<double, 3>;

Point between(const Point& a, const Point& b, double share) {
  Point point{};
  for (std::size_t k = 0; k < 3; ++k) point[k] = a[k] + share * (b[k] - a[k]);
  return point;
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// Half of the longest side times the height on it.
double area_of(const Point& a, const Point& b, const Point& c) {
  Point u{}, v{};
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  return std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
}

struct Measured {
  double area = 0, shortest = std::numeric_limits<double>::infinity();
};

class Definition {
 public:
  explicit Definition(const Complex& complex) : complex_(complex), triangles_(two_skeleton(complex).triangles) {
    const std::vector<std::uint64_t> order = sweep_order(complex);
    std::vector<std::size_t> rank(order.size());
    for (std::size_t r = 0; r < order.size(); ++r) rank[order[r]] = r;
    for (auto& corners : triangles_)
      std::ranges::sort(corners, [&](std::uint64_t a, std::uint64_t b) { return rank[a] < rank[b]; });
  }

  double area() const {
    double sum = 0;
    for (const auto& [lo, mid, hi] : triangles_) sum += area_of(at(lo), at(mid), at(hi));
    return sum;
  }
  bool has_level_triangle() const {
    return std::ranges::any_of(
        triangles_, [&](const auto& corners) { return complex_.values[corners[0]] == complex_.values[corners[2]]; });
  }
  Measured measure(const std::vector<ReferenceArcs::Strip>& strips) const {
    Measured measured;
    for (const ReferenceArcs::Strip& strip : strips) {
      const double bottom = complex_.values[strip.below], top = complex_.values[strip.above];
      if (bottom == top) continue;
      const std::set<std::array<std::uint64_t, 2>> edges(strip.edges.begin(), strip.edges.end());
      // At both ends: the corners of what each triangle has between them.
      double bottom_length = 0, top_length = 0;
      for (const auto& corners : triangles_) {
        if (!edges.contains({corners[0], corners[2]})) continue;
        const auto [a, b] = level_of(corners, bottom, bottom, top);
        const auto [c, d] = level_of(corners, top, bottom, top);
        bottom_length += distance(a, b);
        top_length += distance(c, d);
        measured.area += area_of(a, b, c) + area_of(b, c, d);
      }
      measured.shortest = std::min({measured.shortest, bottom_length, top_length});
    }
    return measured;
  }

 private:
  const Point& at(std::uint64_t vertex) const { return complex_.positions[vertex]; }
  Point on_edge(std::uint64_t a, std::uint64_t b, double level) const {
    const double lo = complex_.values[a], hi = complex_.values[b];
    const double share = std::isfinite(hi - lo) ? (level - lo) / (hi - lo) : (level / 2 - lo / 2) / (hi / 2 - lo / 2);
    return between(at(a), at(b), share);
  }
  // The level as a limit from within bottom .. top, on the side of the longest edge and on the other.
  std::array<Point, 2> level_of(const std::array<std::uint64_t, 3>& corners, double level, double bottom,
                                double top) const {
    const auto [lo, mid, hi] = corners;
    const bool below_mid = top <= complex_.values[mid] && !(bottom >= complex_.values[mid]);
    return {on_edge(lo, hi, level), below_mid ? on_edge(lo, mid, level) : on_edge(mid, hi, level)};
  }

  const Complex& complex_;
  std::vector<std::array<std::uint64_t, 3>> triangles_;
};

// Points, edges and triangles, each once.
Complex surface_of(Complex complex) {
  const Skeleton skeleton = two_skeleton(complex);
  std::erase_if(complex.simplices, [](const auto& simplex) { return simplex.size() != 1; });
  for (const auto& edge : skeleton.edges) complex.simplices.push_back({edge.begin(), edge.end()});
  for (const auto& triangle : skeleton.triangles) complex.simplices.push_back({triangle.begin(), triangle.end()});
  return complex;
}

// The file must be the graph of the mesh.
ooc::MeasuredArcs measure(const ComplexMesh& mesh, const std::string& file, std::uint32_t version, std::uint64_t seed) {
  const ooc::Scratch temp;
  ooc::ComputeOptions options;
  options.threads = 1 + seed % 2;
  options.temp_dir = temp.path();
  if (seed % 3 == 0) options.memory_bytes = 24 << 20;
  ooc::MeshInput input;
  input.indexed = std::make_unique<IndexedComplex>(mesh);
  ColumnFunction function(3);
  const ooc::ReebFile stored(file);
  const auto segmentation = ooc::segment_mesh(std::move(input), function,
                                              {.file = stored,
                                               .version = version,
                                               .vertex_bound = mesh.vertex_count(),
                                               .output = temp.path() + "/out",
                                               .options = std::move(options)});
  UnfinalizedComplex again(mesh, seed);
  return segmentation->measure(again, [](const MeshBatch&) {});
}

constexpr double kTolerance = 1e-9;

TEST(ArcMeasures, EqualTheDefinitionOnRandomComplexes) {
  const std::uint64_t seed = base_seed(), cases = case_count(3'000);
  Runner runner(/*graph_only=*/true);
  runner.options().buckets = 0;
  std::uint64_t exact = 0, doubtful = 0;
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    Complex complex = surface_of(random_complex(seed + i));
    if (complex.vertex_count() > 60) continue;
    Random random(seed + i);
    // A few values that are far from all others, as those that stand for no data.
    const auto is_ordinary = [](double v) { return v == 0 || (std::abs(v) > 1e-6 && std::abs(v) < 1e6); };
    if (i % 2 == 0 && std::ranges::all_of(complex.values, is_ordinary))
      for (double& value : complex.values)
        if (random.below(8) == 0) value = std::ldexp(value + 1, static_cast<int>(random.below(900)));
    for (auto& position : complex.positions)
      for (double& coordinate : position) coordinate = random.unit();
    const ComplexMesh mesh(complex);
    const std::string output = runner.run(mesh, {0, 1, Form::kIndexed})[0];
    const ooc::MeasuredArcs measured = measure(mesh, output, 0, i + 1);
    std::filesystem::remove(output);
    const ReferenceArcs arcs = reference_arcs(complex);
    const Definition definition(complex);
    SCOPED_TRACE(testing::Message() << "case " << i << '\n' << describe(complex));
    ASSERT_EQ(measured.arcs.size(), arcs.strips.size());
    EXPECT_NEAR(measured.area, definition.area(), kTolerance);
    EXPECT_EQ(measured.dropped_area, 0);
    double sum = measured.doubtful_area;
    for (const ArcMeasures& arc : measured.arcs) sum += arc.area;
    EXPECT_NEAR(sum, definition.area(), kTolerance);
    for (std::size_t a = 0; a < arcs.strips.size(); ++a) {
      const Measured expected = definition.measure(arcs.strips[a]);
      const ArcMeasures& found = measured.arcs[a];
      EXPECT_EQ(found.vertices, arcs.vertices[a].size());
      if (std::isinf(expected.shortest)) {
        EXPECT_TRUE(std::isnan(found.shortest_contour));
        continue;
      }
      if (std::isnan(found.shortest_contour)) {
        ++doubtful;
        continue;
      }
      ++exact;
      EXPECT_NEAR(found.shortest_contour, expected.shortest, kTolerance) << "arc " << a;
      if (!definition.has_level_triangle()) {
        EXPECT_NEAR(found.area, expected.area, kTolerance) << "arc " << a;
      }
    }
  }
  EXPECT_GT(exact, 3 * cases);
  EXPECT_GT(doubtful, 0u);
  EXPECT_LT(doubtful, exact);
}

// A prism over a polygon: its contours are all the same, its sides all its area.
TEST(ArcMeasures, OfACylinder) {
  Complex complex;
  constexpr std::size_t kSides = 12, kRings = 9;
  for (std::size_t r = 0; r < kRings; ++r)
    for (std::size_t s = 0; s < kSides; ++s) {
      const double angle = 2 * std::numbers::pi * double(s) / kSides;
      complex.positions.push_back({std::cos(angle), std::sin(angle), double(r) * 0.5});
      complex.values.push_back(double(r) * 0.5);
      if (r == 0) continue;
      const std::uint64_t here = r * kSides + s, next = r * kSides + (s + 1) % kSides;
      complex.simplices.push_back({here, next, here - kSides});
      complex.simplices.push_back({next, here - kSides, next - kSides});
    }
  const ComplexMesh mesh(complex);
  Runner runner;
  const ooc::MeasuredArcs measured = measure(mesh, runner.run(mesh, {0, 1, Form::kIndexed})[0], 0, 1);
  const double around = 2 * kSides * std::sin(std::numbers::pi / kSides);
  double area = 0, shortest = std::numeric_limits<double>::infinity();
  for (const ArcMeasures& arc : measured.arcs) {
    area += arc.area;
    if (!std::isnan(arc.shortest_contour)) shortest = std::min(shortest, arc.shortest_contour);
  }
  EXPECT_NEAR(area, around * 0.5 * (kRings - 1), kTolerance);
  EXPECT_NEAR(shortest, around, kTolerance);
}

// Above the height of its edges, a level has no loop that an edge could span.
TEST(ArcMeasures, NothingIsDoubtfulAboveTheHeightOfEdges) {
  const std::uint64_t seed = base_seed();
  Runner runner;
  runner.options().buckets = 0;
  std::uint64_t some = 0;
  for (std::uint64_t i = 0; i < case_count(300) && !testing::Test::HasFailure(); ++i) {
    Complex complex = surface_of(random_complex(seed + i));
    if (complex.vertex_count() < 10 || complex.vertex_count() > 60) continue;
    const ComplexMesh mesh(complex);
    double highest = 0;
    for (const auto& [a, b] : two_skeleton(complex).edges)
      highest = std::max(highest, std::abs(complex.values[a] - complex.values[b]));
    const std::string output = runner.run(mesh, {0, 1, Form::kIndexed})[0];
    const ooc::ReebFile file(output);
    const std::uint32_t version = file.version_at(std::nextafter(highest, std::numeric_limits<double>::infinity()));
    const bool keeps = std::ranges::any_of(file.pairs(), [](const ooc::PairRow& pair) { return pair.kept; });
    if (keeps) continue;
    const ooc::MeasuredArcs measured = measure(mesh, output, version, i + 1);
    some += measured.arcs.size();
    if (measured.dropped_area == 0) {
      EXPECT_EQ(measured.doubtful_area, 0) << "case " << i << '\n' << describe(complex);
    }
    std::filesystem::remove(output);
  }
  EXPECT_GT(some, 50u);
}

TEST(ArcMeasures, SteepPartsLeaveNothingWhenTheyEnd) {
  LinearSum sum;
  sum.add(1, 0);
  for (double steep = 1; steep < 1e20; steep *= 10) sum.add(steep, 1.0 / 3);
  for (double steep = 1; steep < 1e20; steep *= 10) sum.remove(steep, 1.0 / 3);
  EXPECT_DOUBLE_EQ(sum.at(0.7), 0.7);
}

}  // namespace
}  // namespace reeb::test
