#include "io/cells/cell_division.h"

#include <algorithm>
#include <initializer_list>

namespace reeb::io {
namespace {

using Corners = std::span<const VertexId>;
using Number = std::uint8_t;

void add(CellDivision& division, std::initializer_list<Number> simplex) {
  division.dimension = simplex.size() - 1;
  std::ranges::copy(simplex, division.corners.begin() + static_cast<std::ptrdiff_t>(division.count * simplex.size()));
  ++division.count;
}

Number lowest(Corners corners) { return static_cast<Number>(std::ranges::min_element(corners) - corners.begin()); }

CellDivision whole(std::size_t corners) {
  CellDivision division{corners - 1, 1, {}};
  for (std::size_t i = 0; i < corners; ++i) division.corners[i] = static_cast<Number>(i);
  return division;
}

// The quadrilateral with these corners of a cell, around it.
using Face = std::array<Number, 4>;

// Calls use(a, b, c) for both triangles.
template <class Use>
void divide_face(const Face& face, Corners corners, const Use& use) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (corners[face[i]] < corners[face[first]]) first = i;
  const auto at = [&](std::size_t i) { return face[(first + i) % 4]; };
  use(at(0), at(1), at(2));
  use(at(0), at(2), at(3));
}

// All tetrahedra contain the lowest vertex. So they are given by the triangles of the faces without it.
CellDivision cone(Corners corners, std::initializer_list<std::array<Number, 3>> triangles,
                  std::initializer_list<Face> quadrilaterals) {
  CellDivision division;
  const Number apex = lowest(corners);
  for (const auto& [a, b, c] : triangles)
    if (a != apex && b != apex && c != apex) add(division, {apex, a, b, c});
  for (const Face& face : quadrilaterals) {
    if (std::ranges::find(face, apex) != face.end()) continue;
    divide_face(face, corners, [&](Number a, Number b, Number c) { add(division, {apex, a, b, c}); });
  }
  return division;
}

CellDivision divide_quadrilateral(Corners corners, const Face& around) {
  CellDivision division;
  divide_face(around, corners, [&](Number a, Number b, Number c) { add(division, {a, b, c}); });
  return division;
}

// Corner c of a cube, whose bits are its coordinates, is corner number_of[c] of the cell.
CellDivision divide_cube(Corners corners, const std::array<Number, 8>& number_of) {
  unsigned origin = 0;
  for (unsigned c = 1; c < 8; ++c)
    if (corners[number_of[c]] < corners[number_of[origin]]) origin = c;
  // The cube is reflected so that the lowest vertex is corner 0; corner 7 is opposite to it.
  const auto at = [&](unsigned c) { return number_of[c ^ origin]; };

  // Of the three faces without corner 0, face k contains 1 << k, the diagonals there end at it and at 7, or at the
  // other two.
  struct Opposite {
    unsigned near, left, right;
    bool through_far;
  };
  std::array<Opposite, 3> faces{};
  unsigned through_far = 0, special = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned near = 1u << k;
    Opposite& face = faces[k] = {near, near | 1u << (k + 1) % 3, near | 1u << (k + 2) % 3, false};
    const auto on_diagonal = std::min(corners[at(near)], corners[at(7)]);
    face.through_far = on_diagonal < std::min(corners[at(face.left)], corners[at(face.right)]);
    if (!face.through_far) continue;
    ++through_far;
    special = k;
  }

  CellDivision division;
  const auto tetrahedron = [&](unsigned a, unsigned b, unsigned c, unsigned d) {
    add(division, {at(a), at(b), at(c), at(d)});
  };
  if (through_far == 0) {
    tetrahedron(0, 3, 5, 6);
    tetrahedron(7, 3, 5, 6);
    tetrahedron(1, 0, 3, 5);
    tetrahedron(2, 0, 3, 6);
    tetrahedron(4, 0, 5, 6);
  } else if (through_far == 1) {
    // The inner edge joins the near corner of that face to the corner opposite to it.
    const auto [near, left, right, through] = faces[special];
    const unsigned far = 7 ^ near;
    tetrahedron(0, near, far, left);
    tetrahedron(0, near, far, right);
    tetrahedron(7, near, far, left);
    tetrahedron(7, near, far, right);
    tetrahedron(0, far, left, left ^ near);
    tetrahedron(0, far, right, right ^ near);
  } else {
    for (const auto& [near, left, right, through] : faces) {
      if (through) {
        tetrahedron(0, near, 7, left);
        tetrahedron(0, near, 7, right);
      } else {
        tetrahedron(0, left, right, near);
        tetrahedron(0, left, right, 7);
      }
    }
  }
  return division;
}

}  // namespace

std::size_t corner_count(CellShape shape) {
  switch (shape) {
    case CellShape::kPoints:
    case CellShape::kPolyline:
    case CellShape::kPolygon:
    case CellShape::kStrip:
      return 0;
    case CellShape::kPoint:
      return 1;
    case CellShape::kEdge:
      return 2;
    case CellShape::kTriangle:
      return 3;
    case CellShape::kQuadrilateral:
    case CellShape::kPixel:
    case CellShape::kTetrahedron:
      return 4;
    case CellShape::kPyramid:
      return 5;
    case CellShape::kPrism:
      return 6;
    case CellShape::kHexahedron:
    case CellShape::kVoxel:
      break;
  }
  return 8;
}

CellDivision divide_cell(CellShape shape, Corners corners) {
  switch (shape) {
    case CellShape::kQuadrilateral:
      return divide_quadrilateral(corners, {0, 1, 2, 3});
    case CellShape::kPixel:
      return divide_quadrilateral(corners, {0, 1, 3, 2});
    case CellShape::kHexahedron:
      return divide_cube(corners, {0, 1, 3, 2, 4, 5, 7, 6});
    case CellShape::kVoxel:
      return divide_cube(corners, {0, 1, 2, 3, 4, 5, 6, 7});
    case CellShape::kPrism:
      return cone(corners, {{0, 1, 2}, {3, 4, 5}}, {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
    case CellShape::kPyramid:
      return cone(corners, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, {{0, 1, 2, 3}});
    default:
      return whole(corner_count(shape));
  }
}

}  // namespace reeb::io
