// Curves, kinds and relations on surfaces whose curves are known.
#include "libreeb/defects/loop_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libreeb/base/sweep_key.h"
#include "libreeb/defects/curve_length.h"
#include "libreeb/defects/curve_relations.h"
#include "libreeb/defects/defect_lengths.h"

namespace reeb {
namespace {

constexpr std::uint32_t kRings = 40, kSides = 24;
constexpr double kPi = 3.14159265358979;

// A torus of radii 3 and 1 around the y axis, slightly turned; vertex (ring, side) is ring * kSides + side.
PatchContent torus(bool inwards = false) {
  PatchContent content;
  for (std::uint32_t i = 0; i < kRings; ++i)
    for (std::uint32_t j = 0; j < kSides; ++j) {
      const double a = 2 * kPi * (i + 0.3) / kRings, b = 2 * kPi * (j + 0.2) / kSides, r = 3 + std::cos(b);
      content.vertices.emplace_back(i * kSides + j);
      content.positions.push_back({r * std::cos(a), std::sin(b), r * std::sin(a)});
      content.whole.push_back(1);
      const std::uint32_t right = (i + 1) % kRings * kSides, up = (j + 1) % kSides, here = i * kSides;
      const std::array<std::uint32_t, 3> t = {here + j, here + up, right + j}, u = {right + j, here + up, right + up};
      for (auto triangle : {t, u}) {
        if (inwards) std::swap(triangle[1], triangle[2]);
        content.triangles.push_back(triangle);
      }
    }
  return content;
}

std::vector<double> heights(const PatchContent& content) {
  std::vector<double> values;
  for (const Point& p : content.positions) values.push_back(p[2] + 0.01 * p[0] + 0.003 * p[1]);
  return values;
}

// The short circle of the torus at this ring.
ClosedPath circle_at(std::uint32_t ring) {
  ClosedPath path;
  for (std::uint32_t j = 0; j < kSides; ++j) path.vertices.push_back(ring * kSides + j);
  return path;
}

// The two nodes of the loop: on the inner circle, lowest and highest.
std::pair<std::uint32_t, std::uint32_t> loop_of(const PatchContent& content, const std::vector<double>& values) {
  std::uint32_t v = 0, y = 0;
  double least = 1e9, most = -1e9;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    if (content.vertices[i].value() % kSides != kSides / 2) continue;
    if (values[i] < least) least = values[v = i];
    if (values[i] > most) most = values[y = i];
  }
  return {v, y};
}

TEST(LoopCurves, OfATorusAreItsCircles) {
  for (const bool inwards : {false, true}) {
    const PatchContent content = torus(inwards);
    const auto values = heights(content);
    const auto [v, y] = loop_of(content, values);
    const SurfacePatch patch(content);
    const LoopCurves curves = loop_curves(patch, values, {v, y, true, true});
    EXPECT_NEAR(curves.contour.length, 2 * kPi, 0.1);
    EXPECT_NEAR(curves.cycle.length, 4 * kPi, 0.3);
    // The short circle is inside the solid.
    EXPECT_EQ(kind_of(patch, curves.shorter(), inwards), DefectKind::kHandle);
    EXPECT_EQ(kind_of(patch, curves.cycle, inwards), DefectKind::kTunnel);
  }
}

TEST(LoopCurves, OrientationIsMadeConsistentFirst) {
  PatchContent content = torus();
  for (std::size_t t = 0; t < content.triangles.size(); t += 3)
    std::swap(content.triangles[t][0], content.triangles[t][2]);
  const auto values = heights(content);
  const auto [v, y] = loop_of(content, values);
  const SurfacePatch patch(content);
  const LoopCurves curves = loop_curves(patch, values, {v, y, true, true});
  EXPECT_EQ(kind_of(patch, curves.shorter(), false), DefectKind::kHandle);
}

TEST(LoopCurves, AtABoundaryAreUnclear) {
  PatchContent content = torus();
  // Without the triangles of a ring, the torus is a cylinder: every short circle is around a boundary.
  std::erase_if(content.triangles, [](const auto& t) { return t[0] / kSides == 7 || t[1] / kSides == 7; });
  const auto values = heights(content);
  const auto [v, y] = loop_of(content, values);
  const SurfacePatch patch(content);
  const LoopCurves curves = loop_curves(patch, values, {v, y, true, true});
  EXPECT_EQ(kind_of(patch, curves.shorter(), false), DefectKind::kUnclear);
  EXPECT_EQ(kind_of(patch, curve_along(patch, circle_at(15)), false), DefectKind::kUnclear);
  // The same circle, if nothing is missing.
  const SurfacePatch closed(torus());
  EXPECT_EQ(kind_of(closed, curve_along(closed, circle_at(15)), false), DefectKind::kHandle);
}

// Three tetrahedra in a ring, each of which shares one vertex with the next. No path along edges goes around a
// tetrahedron there, but a contour does.
TEST(LoopCurves, AContourWithoutAPathHasAPlace) {
  PatchContent content;
  content.positions = {{0, 0, 0}, {10, 0, 1}, {5, 8, 2}};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t from = i, to = (i + 1) % 3, p = 3 + 2 * i;
    const Point a = content.positions[from], b = content.positions[to];
    const Point middle = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    content.positions.push_back({middle[0] + 0.1, middle[1], middle[2] + 1});
    content.positions.push_back({middle[0] - 0.1, middle[1] + 1, middle[2]});
    for (const auto& t : {std::array{from, to, p}, {to, from, p + 1}, {p, to, p + 1}, {from, p, p + 1}})
      content.triangles.push_back(t);
  }
  std::vector<double> values;
  for (std::uint32_t i = 0; i < content.positions.size(); ++i) {
    content.vertices.emplace_back(i);
    content.whole.push_back(1);
    values.push_back(content.positions[i][0]);
  }
  const SurfacePatch patch(content);
  const LoopCurve contour = loop_curves(patch, values, {0, 1, true, true}).contour;
  ASSERT_TRUE(contour.found());
  ASSERT_FALSE(contour.path.exists());
  const auto& [box, center] = contour.place;
  EXPECT_GT(distance(box[0], box[1]), 0);
  EXPECT_LE(distance(box[0], box[1]), contour.length);
  EXPECT_NEAR(box[0][0], box[1][0], 1e-12) << "it is at one height";
  EXPECT_TRUE(0 < box[0][0] && box[0][0] < 10);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(box[0][k] <= center[k] && center[k] <= box[1][k]);
}

TEST(LoopCurves, BoundTogetherIfOneIsBesideTheOther) {
  // Without a ring of triangles, which the patch does not have: vertices there are not whole.
  PatchContent content = torus();
  std::erase_if(content.triangles, [](const auto& t) { return t[0] / kSides == 7 || t[1] / kSides == 7; });
  for (const std::uint32_t ring : {7u, 8u})
    for (std::uint32_t j = 0; j < kSides; ++j) content.whole[ring * kSides + j] = 0;
  const SurfacePatch patch(content);
  const auto left_of_ring = [&](std::uint32_t ring) { return left_of(patch, circle_at(ring)).value(); };
  EXPECT_TRUE(bound_together(patch, left_of_ring(15), left_of_ring(30)));
  EXPECT_FALSE(bound_together(patch, left_of_ring(15), Crossings(patch.edge_count(), 0)));
}

TEST(CurveLength, IsThatOfATightString) {
  const SurfacePatch patch(torus());
  // A circle around the tube that steps to the next ring and back.
  ClosedPath path;
  for (std::uint32_t j = 0; j < kSides; ++j) path.vertices.push_back((j >= 6 && j < 12 ? 6 : 5) * kSides + j);
  path.length = 0;
  for (std::size_t i = 0; i < path.vertices.size(); ++i)
    path.length += distance(patch.position(path.vertices[i]), patch.position(path.vertices[(i + 1) % kSides]));
  EXPECT_GT(path.length, 2 * kPi + 0.3);
  EXPECT_NEAR(tight_length(patch, path), 2 * kPi, 0.12);
}

std::vector<std::uint32_t> circle(const SurfacePatch& patch, std::uint32_t ring) {
  std::vector<std::uint32_t> edges;
  for (std::uint32_t j = 0; j < kSides; ++j)
    edges.push_back(patch.edge_between(ring * kSides + j, ring * kSides + (j + 1) % kSides));
  return edges;
}

using Curves = std::vector<std::vector<std::uint32_t>>;

TEST(CurveRelations, TwoCirclesBoundTogether) {
  const SurfacePatch patch(torus());
  const auto first = circle(patch, 3), second = circle(patch, 20);
  EXPECT_FALSE(bounds_with(patch, first, {}));
  EXPECT_TRUE(bounds_with(patch, first, Curves{second}));
  EXPECT_TRUE(bounds_with(patch, first, Curves{first}));
  std::vector<std::uint32_t> around;
  for (std::uint32_t i = 0; i < kRings; ++i)
    around.push_back(patch.edge_between(i * kSides, (i + 1) % kRings * kSides));
  EXPECT_FALSE(bounds_with(patch, around, Curves{first, second}));
  std::vector<std::uint32_t> triangle(patch.edges_of(0).begin(), patch.edges_of(0).end());
  EXPECT_TRUE(bounds_with(patch, triangle, {}));
}

TEST(DefectLengths, AreDividedAtTheGap) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<double> lengths = {3, 4, 5, 4.5, 40, 60, kInfinity};
  const auto suggested = suggest_length(lengths, 0.5, 200);
  ASSERT_TRUE(suggested.length);
  EXPECT_GT(*suggested.length, 5);
  EXPECT_LT(*suggested.length, 40);
  EXPECT_GT(suggested.confidence, 0.6);
  // Sizes of defects differ more than the border is from the longest of them.
  const std::vector<double> wide = {4.5, 25, 58, 59};
  const auto border = suggest_length(wide, 0.6, 120);
  ASSERT_TRUE(border.length);
  EXPECT_GT(*border.length, 25);
  EXPECT_LT(*border.length, 58);
  // Nothing longer shows where features begin.
  const auto alone = suggest_length(std::vector{3.0}, 1, 1000);
  ASSERT_TRUE(alone.length);
  EXPECT_LE(alone.confidence, 0.5);
  EXPECT_EQ(alone.why, "the only loop is 3 long (3 edges); none is longer, so nothing shows where features begin");
  EXPECT_FALSE(suggest_length({}, 1, 10).length);
  EXPECT_FALSE(suggest_length(std::vector{100.0, 150.0}, 1, 1000).length);
  EXPECT_FALSE(suggest_length(std::vector{kInfinity}, 1, 1000).length);
  // Loops without a curve are long ones only if curves were looked for along several functions.
  const std::vector<double> unknown = {3, 4, kInfinity, kInfinity};
  EXPECT_GT(suggest_length(unknown, 1, 1000).confidence, 0.9);
  const auto unsure = suggest_length(unknown, 1, 1000, false);
  ASSERT_TRUE(unsure.length);
  EXPECT_LE(unsure.confidence, 0.5);
  EXPECT_EQ(unsure.why,
            "2 of 4 loops are at most 4 long (4 edges); of the other 2 no short curve was found; "
            "graphs of other functions may "
            "have one");
  EXPECT_LE(suggest_length(std::vector{kInfinity}, 1, 1000, false).confidence, 0.5);
}

}  // namespace
}  // namespace reeb
