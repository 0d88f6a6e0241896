// The division of cells against what it promises, for every order of the vertices.
#include "io/cells/cell_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace reeb::io {
namespace {

using Point = std::array<double, 3>;
using Simplex = std::set<std::uint64_t>;

struct Cell {
  CellShape shape;
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> faces;  // around each
  std::set<std::size_t> most_simplices;
};

const std::vector<Point> kCube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

std::vector<Cell> solids() {
  Cell hexahedron{CellShape::kHexahedron,
                  kCube,
                  {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
                  {5, 6}};
  Cell voxel{CellShape::kVoxel,
             kCube,
             {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}},
             {5, 6}};
  std::swap(voxel.points[2], voxel.points[3]);
  std::swap(voxel.points[6], voxel.points[7]);
  Cell prism{CellShape::kPrism,
             {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
             {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
             {3}};
  Cell pyramid{CellShape::kPyramid,
               {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.25, 0.5, 1}},
               {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
               {2}};
  Cell tetrahedron{CellShape::kTetrahedron,
                   {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}},
                   {1}};
  return {hexahedron, voxel, prism, pyramid, tetrahedron};
}

double volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto edge = [&](const Point& to, std::size_t k) { return to[k] - a[k]; };
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    sum += edge(b, k) * (edge(c, l) * edge(d, m) - edge(c, m) * edge(d, l));
  }
  return std::abs(sum) / 6;
}

// Of a convex cell: a fan of pyramids from its centre.
double volume(const Cell& cell) {
  Point centre{};
  for (const Point& point : cell.points)
    for (std::size_t k = 0; k < 3; ++k) centre[k] += point[k] / static_cast<double>(cell.points.size());
  double sum = 0;
  for (const auto& face : cell.faces)
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
      sum += volume(centre, cell.points[face[0]], cell.points[face[i]], cell.points[face[i + 1]]);
  return sum;
}

// The triangles of a face by the rule, from its definition: the diagonal at the lowest vertex.
std::set<Simplex> triangles_of(const std::vector<std::size_t>& face, const std::vector<VertexId>& ids) {
  std::vector<std::uint64_t> names;
  for (const std::size_t corner : face) names.push_back(ids[corner].value());
  if (names.size() == 3) return {Simplex(names.begin(), names.end())};
  std::rotate(names.begin(), std::ranges::min_element(names), names.end());
  return {{names[0], names[1], names[2]}, {names[0], names[2], names[3]}};
}

TEST(CellDivision, FillsTheCellAndDividesItsFacesByTheRule) {
  for (const Cell& cell : solids()) {
    SCOPED_TRACE(static_cast<int>(cell.shape));
    const std::size_t count = cell.points.size();
    ASSERT_EQ(corner_count(cell.shape), count);
    std::vector<VertexId> ids;
    for (std::size_t i = 0; i < count; ++i) ids.emplace_back(10 + i);
    std::set<std::size_t> sizes;
    do {
      const CellDivision division = divide_cell(cell.shape, ids);
      ASSERT_EQ(division.dimension, 3u);
      sizes.insert(division.count);
      double filled = 0;
      std::map<Simplex, int> faces;
      for (std::size_t t = 0; t < division.count; ++t) {
        const std::uint8_t* const corner = &division.corners[4 * t];
        ASSERT_LT(*std::max_element(corner, corner + 4), count);
        const double part =
            volume(cell.points[corner[0]], cell.points[corner[1]], cell.points[corner[2]], cell.points[corner[3]]);
        ASSERT_GT(part, 1e-9);
        filled += part;
        for (std::size_t without = 0; without < 4; ++without) {
          Simplex face;
          for (std::size_t k = 0; k < 4; ++k)
            if (k != without) face.insert(ids[corner[k]].value());
          ++faces[face];
        }
      }
      ASSERT_NEAR(filled, volume(cell), 1e-9);
      // Inner triangles have two tetrahedra, those of the surface one.
      std::set<Simplex> surface, expected;
      for (const auto& [face, uses] : faces) {
        ASSERT_LE(uses, 2);
        if (uses == 1) surface.insert(face);
      }
      for (const auto& face : cell.faces) expected.merge(triangles_of(face, ids));
      ASSERT_EQ(surface, expected);
    } while (std::ranges::next_permutation(ids).found);
    EXPECT_EQ(sizes, cell.most_simplices);
  }
}

TEST(CellDivision, NeighboursDivideTheirFaceAlike) {
  // Two cubes side by side, with all orders of the four shared vertices among the others.
  std::vector<std::uint64_t> names(12);
  std::iota(names.begin(), names.end(), 0u);
  std::uint64_t state = 1;
  for (int trial = 0; trial < 3000; ++trial) {
    for (std::size_t i = names.size(); i-- > 1;) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      std::swap(names[i], names[(state >> 33) % (i + 1)]);
    }
    const auto faces = [&](std::array<std::size_t, 8> corners) {
      std::vector<VertexId> ids;
      for (const std::size_t corner : corners) ids.emplace_back(names[corner]);
      const std::set<std::uint64_t> shared(names.begin() + 4, names.begin() + 8);
      std::set<Simplex> found;
      const CellDivision division = divide_cell(CellShape::kHexahedron, ids);
      for (std::size_t t = 0; t < division.count; ++t) {
        Simplex face;
        for (std::size_t k = 0; k < 4; ++k)
          if (const auto id = ids[division.corners[4 * t + k]].value(); shared.contains(id)) face.insert(id);
        if (face.size() == 3) found.insert(face);
      }
      return found;
    };
    const auto left = faces({0, 1, 2, 3, 4, 5, 6, 7});
    // The second cube lists the shared face first, from another corner and the other way around.
    const auto right = faces({6, 5, 4, 7, 10, 9, 8, 11});
    ASSERT_EQ(left.size(), 2u);
    ASSERT_EQ(left, right);
  }
}

TEST(CellDivision, AQuadrilateralIsDividedAtItsLowestVertex) {
  std::vector<VertexId> ids = {VertexId(0), VertexId(1), VertexId(2), VertexId(3)};
  do {
    for (const CellShape shape : {CellShape::kQuadrilateral, CellShape::kPixel}) {
      const CellDivision division = divide_cell(shape, ids);
      ASSERT_EQ(division.dimension, 2u);
      ASSERT_EQ(division.count, 2u);
      std::set<Simplex> found;
      for (std::size_t t = 0; t < 2; ++t) {
        Simplex triangle;
        for (std::size_t k = 0; k < 3; ++k) triangle.insert(ids[division.corners[3 * t + k]].value());
        found.insert(triangle);
      }
      const bool pixel = shape == CellShape::kPixel;
      EXPECT_EQ(found,
                triangles_of(pixel ? std::vector<std::size_t>{0, 1, 3, 2} : std::vector<std::size_t>{0, 1, 2, 3}, ids));
    }
  } while (std::ranges::next_permutation(ids).found);
}

TEST(CellDivision, SimplicesStayWhole) {
  const std::vector<VertexId> ids = {VertexId(5), VertexId(3), VertexId(4), VertexId(1)};
  for (const auto& [shape, corners] : {std::pair(CellShape::kPoint, 1u),
                                       {CellShape::kEdge, 2u},
                                       {CellShape::kTriangle, 3u},
                                       {CellShape::kTetrahedron, 4u}}) {
    const CellDivision division = divide_cell(shape, std::span(ids).first(corners));
    EXPECT_EQ(division.count, 1u);
    EXPECT_EQ(division.dimension + 1, corners);
    for (std::size_t i = 0; i < corners; ++i) EXPECT_EQ(division.corners[i], i);
  }
}

}  // namespace
}  // namespace reeb::io
