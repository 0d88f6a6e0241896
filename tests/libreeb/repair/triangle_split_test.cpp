// Divided triangles: their areas, and the room beside curves on a torus of seven vertices.
#include "libreeb/repair/triangle_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "libreeb/repair/curve_cut.h"
#include "libreeb/repair/triangle_crossing.h"

namespace reeb::test {
namespace {

using Vertices = std::vector<std::uint32_t>;

std::uint32_t count_there(const EditablePatch& patch) {
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < patch.triangle_count(); ++t) count += patch.triangle(t).there ? 1u : 0u;
  return count;
}

// Twice the area in the plane z = 0.
double area(const EditablePatch& patch, std::uint32_t t) {
  const auto& c = patch.triangle(t).corners;
  const Point &a = patch.position(c[0]), &b = patch.position(c[1]), &d = patch.position(c[2]);
  return (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
}

TEST(TriangleSplit, PartsHaveTheAreaOfTheWhole) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 500; ++round) {
    EditablePatch patch;
    // Numbers of corners in any order.
    std::array<std::uint32_t, 3> corner = {0, 1, 2};
    std::shuffle(corner.begin(), corner.end(), random);
    const std::array<Point, 3> at = {{{0, 0, 0}, {12, 0, 0}, {3, 12, 0}}};
    for (std::uint32_t v = 0; v < 3; ++v)
      patch.add_vertex(
          {VertexId(v), at[static_cast<std::size_t>(std::ranges::find(corner, v) - corner.begin())], true, false, {}});
    patch.add_triangle({corner[0], corner[1], corner[2]}, 0);
    TriangleSplit split(patch, false);
    Vertices points;
    for (std::size_t i = 0; i < 3; ++i)
      for (int k = 0; k < static_cast<int>(random() % 3); ++k)
        points.push_back(split.point_on(corner[i], corner[(i + 1) % 3], 1 + static_cast<int>(random() % 11)));
    if (points.empty()) continue;
    const std::uint32_t from = points[0], to = points.back();
    split.join(0, from, to);
    const PatchSplit done = split.run();
    double sum = 0;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::uint32_t t = 1; t < patch.triangle_count(); ++t) {
      EXPECT_GT(area(patch, t), 0);
      sum += area(patch, t);
      const auto& c = patch.triangle(t).corners;
      for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(edges.emplace(c[i], c[(i + 1) % 3]).second);
    }
    EXPECT_NEAR(sum, 144, 1e-9);
    EXPECT_FALSE(patch.triangle(0).there);
    // Every point is used, and the way is there if its ends are on different edges.
    for (const std::uint32_t v : points) EXPECT_TRUE(patch.is_used(v));
    const Point &p = patch.position(from), &q = patch.position(to);
    const auto on_same_edge = [&] {
      for (std::size_t i = 0; i < 3; ++i) {
        const Point &a = at[i], &b = at[(i + 1) % 3];
        const auto off = [&](const Point& x) {
          return std::abs((b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]));
        };
        if (off(p) < 1e-9 && off(q) < 1e-9) return true;
      }
      return false;
    };
    EXPECT_TRUE(on_same_edge() || patch.has_edge(from, to));
    undo_split(patch, done);
    EXPECT_EQ(patch.vertex_count(), 3u);
    EXPECT_EQ(count_there(patch), 1u);
  }
}

// Every two vertices are joined, so no curve has a free ring of triangles beside it.
TEST(TriangleSplit, MakesRoomOnTheSmallestTorus) {
  for (std::uint32_t step = 1; step < 4; ++step)
    for (std::uint32_t start = 0; start < 7; ++start) {
      EditablePatch patch;
      for (std::uint32_t v = 0; v < 7; ++v) {
        const double x = v;
        patch.add_vertex({VertexId(v), {x, x * x, x * x * x}, true, false, {}});
      }
      for (std::uint32_t v = 0; v < 7; ++v) {
        patch.add_triangle({v, (v + 1) % 7, (v + 3) % 7}, 2 * v);
        patch.add_triangle({v, (v + 3) % 7, (v + 2) % 7}, 2 * v + 1);
      }
      const Vertices curve = {start, (start + step) % 7, (start + 2 * step) % 7};
      const PatchSplit split = make_room(patch, curve, false);
      std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
      std::set<std::uint32_t> used;
      for (std::uint32_t t = 0; t < patch.triangle_count(); ++t) {
        if (!patch.triangle(t).there) continue;
        const auto& c = patch.triangle(t).corners;
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_TRUE(edges.emplace(c[i], c[(i + 1) % 3]).second);
          used.insert(c[i]);
        }
      }
      for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
      EXPECT_EQ(used.size() + count_there(patch), edges.size() / 2);
      for (const std::uint32_t v : used) EXPECT_TRUE(patch.is_closed_fan(v)) << v;
      // All other edges of the curve's vertices lead to vertices of degree two rings away: none is a vertex of the
      // torus.
      for (const std::uint32_t v : curve)
        patch.for_each_at(v, [&](std::uint32_t t) {
          for (const std::uint32_t w : patch.triangle(t).corners)
            EXPECT_TRUE(w >= 7 || std::ranges::count(curve, w) == 1) << w;
        });
      undo_split(patch, split);
      EXPECT_EQ(count_there(patch), 14u);
    }
}

// Császár's polyhedron: the smallest torus with flat triangles that do not cross. Every triangle that is not at a curve
// of three edges has corners on both sides of it, so there is no band without new vertices.
TEST(TriangleSplit, LetsTheSmallestTorusBeCut) {
  const std::array<Point, 7> places = {
      {{3, -3, 0}, {3, 3, 1}, {1, 2, 3}, {-1, -2, 3}, {-3, -3, 1}, {-3, 3, 0}, {0, 0, 15}}};
  const auto faces = [](const std::array<std::uint32_t, 7>& name) {
    std::vector<EditablePatch::Corners> list;
    for (std::uint32_t v = 0; v < 7; ++v) {
      list.push_back({name[v], name[(v + 1) % 7], name[(v + 3) % 7]});
      list.push_back({name[v], name[(v + 3) % 7], name[(v + 2) % 7]});
    }
    return list;
  };
  const auto crosses = [&](const std::vector<EditablePatch::Corners>& list) {
    const auto placed = [&](const EditablePatch::Corners& c) {
      return PlacedTriangle{c, {places[c[0]], places[c[1]], places[c[2]]}};
    };
    for (std::size_t i = 0; i < list.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (triangles_cross(placed(list[i]), placed(list[j]))) return true;
    return false;
  };
  std::array<std::uint32_t, 7> name = {0, 1, 2, 3, 4, 5, 6};
  while (crosses(faces(name))) ASSERT_TRUE(std::next_permutation(name.begin(), name.end()));
  std::size_t cut = 0;
  for (std::uint32_t a = 0; a < 7; ++a)
    for (std::uint32_t b = 0; b < a; ++b)
      for (std::uint32_t c = 0; c < b; ++c) {
        EditablePatch patch;
        for (std::uint32_t v = 0; v < 7; ++v) patch.add_vertex({VertexId(v), places[v], true, false, {}});
        std::uint64_t id = 0;
        for (const auto& corners : faces(name)) patch.add_triangle(corners, id++);
        const Cut result = cut_along(patch, Vertices{a, b, c}, {});
        if (!result.done) {
          EXPECT_EQ(count_there(patch), 14u);
          continue;
        }
        ++cut;
        EXPECT_TRUE(result.connected);
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        std::set<std::uint32_t> used;
        for (std::uint32_t t = 0; t < patch.triangle_count(); ++t)
          if (patch.triangle(t).there)
            for (std::size_t i = 0; i < 3; ++i) {
              const auto& corners = patch.triangle(t).corners;
              EXPECT_TRUE(edges.emplace(corners[i], corners[(i + 1) % 3]).second);
              used.insert(corners[i]);
            }
        for (const auto& [p, q] : edges) EXPECT_TRUE(edges.contains({q, p}));
        EXPECT_EQ(used.size() + count_there(patch), edges.size() / 2 + 2);
      }
  EXPECT_GT(cut, 0u);
}

}  // namespace
}  // namespace reeb::test
