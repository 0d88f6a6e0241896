#include "io/vtk/vtk_cell_type.h"

#include <algorithm>
#include <iterator>

#include "io/text/hints.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

struct VtkType {
  std::int64_t number = 0;
  CellShape shape = CellShape::kPoint;
  std::uint64_t nodes = 0;  // all of them; 0: any number of corners, or corners and more
  bool higher_order = false;
};

constexpr VtkType kTypes[] = {
    {1, CellShape::kPoint, 1},
    {2, CellShape::kPoints},
    {3, CellShape::kEdge, 2},
    {4, CellShape::kPolyline},
    {5, CellShape::kTriangle, 3},
    {6, CellShape::kStrip},
    {7, CellShape::kPolygon},
    {8, CellShape::kPixel, 4},
    {9, CellShape::kQuadrilateral, 4},
    {10, CellShape::kTetrahedron, 4},
    {11, CellShape::kVoxel, 8},
    {12, CellShape::kHexahedron, 8},
    {13, CellShape::kPrism, 6},
    {14, CellShape::kPyramid, 5},
    {21, CellShape::kEdge, 3, true},
    {22, CellShape::kTriangle, 6, true},
    {23, CellShape::kQuadrilateral, 8, true},
    {24, CellShape::kTetrahedron, 10, true},
    {25, CellShape::kHexahedron, 20, true},
    {26, CellShape::kPrism, 15, true},
    {27, CellShape::kPyramid, 13, true},
    {28, CellShape::kQuadrilateral, 9, true},
    {29, CellShape::kHexahedron, 27, true},
    {30, CellShape::kQuadrilateral, 6, true},
    {31, CellShape::kPrism, 12, true},
    {32, CellShape::kPrism, 18, true},
    {33, CellShape::kHexahedron, 24, true},
    {34, CellShape::kTriangle, 7, true},
    {35, CellShape::kEdge, 4, true},
    {36, CellShape::kPolygon, 0, true},
    {37, CellShape::kPyramid, 19, true},
    // Lagrange and Bezier cells: any order.
    {68, CellShape::kEdge, 0, true},
    {69, CellShape::kTriangle, 0, true},
    {70, CellShape::kQuadrilateral, 0, true},
    {71, CellShape::kTetrahedron, 0, true},
    {72, CellShape::kHexahedron, 0, true},
    {73, CellShape::kPrism, 0, true},
    {74, CellShape::kPyramid, 0, true},
    {75, CellShape::kEdge, 0, true},
    {76, CellShape::kTriangle, 0, true},
    {77, CellShape::kQuadrilateral, 0, true},
    {78, CellShape::kTetrahedron, 0, true},
    {79, CellShape::kHexahedron, 0, true},
    {80, CellShape::kPrism, 0, true},
    {81, CellShape::kPyramid, 0, true},
};

const VtkType* find_type(std::int64_t number) {
  const auto* const found = std::ranges::find(kTypes, number, &VtkType::number);
  return found == std::end(kTypes) ? nullptr : found;
}

}  // namespace

bool has_inner_nodes(std::int64_t vtk_type) {
  const VtkType* const type = find_type(vtk_type);
  return type != nullptr && type->higher_order;
}

CellHead vtk_cell(std::int64_t number, std::uint64_t nodes) {
  if (number == 0) {  // an empty cell
    if (nodes == 0) return {CellShape::kPoints, 0, 0};
    throw Error(ErrorKind::kBadInput, "an empty cell has " + count_of(nodes, "node"), kDamagedHereHint);
  }
  const VtkType* const type = find_type(number);
  if (type == nullptr)
    throw Error(ErrorKind::kBadInput,
                number == 42 ? std::string("a cell is a polyhedron, which is not read")
                             : "a cell is of VTK's type " + std::to_string(number) + ", which is not read",
                "divide such cells into tetrahedra first (in ParaView: the filter Tetrahedralize)");
  const std::uint64_t fixed = corner_count(type->shape);
  const bool fits = type->nodes != 0 ? nodes == type->nodes : nodes >= fixed;
  const bool odd_polygon = type->higher_order && fixed == 0 && nodes % 2 != 0;
  if (!fits || odd_polygon)
    throw Error(ErrorKind::kBadInput,
                "a cell of VTK's type " + std::to_string(number) + " cannot have " + count_of(nodes, "node"),
                kDamagedHereHint);
  if (fixed == 0) {
    const std::uint64_t corners = type->higher_order ? nodes / 2 : nodes;
    return {type->shape, corners, nodes - corners};
  }
  return {type->shape, fixed, nodes - fixed};
}

}  // namespace reeb::io
