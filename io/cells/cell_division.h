// How cells with more corners than a simplex are divided into simplices, without new vertices.
//
// Every quadrilateral is divided by the diagonal at its vertex of lowest index. So two cells that share a quadrilateral
// divide it alike, however their corners are listed. Prisms and pyramids follow from that: all simplices contain the
// lowest vertex. Hexahedra are divided as in J. Dompierre, P. Labbé, M.-G. Vallet, R. Camarero, "How to subdivide
// pyramids, prisms and hexahedra into tetrahedra" (8th International Meshing Roundtable, 1999): into five tetrahedra if
// no diagonal of the six faces ends at the corner opposite to the lowest vertex, else into six.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "libreeb/base/ids.h"

namespace reeb::io {

// Corners are in the order of VTK, which is also that of MSH and Medit: around the base (or the first triangle), then
// above them. A pixel and a voxel are a quadrilateral and a hexahedron whose corners count in binary.
enum class CellShape : std::uint8_t {
  // Any number of corners: each alone; each with its predecessor; a fan from the first; a strip of triangles.
  kPoints,
  kPolyline,
  kPolygon,
  kStrip,
  // A fixed number.
  kPoint,
  kEdge,
  kTriangle,
  kQuadrilateral,
  kPixel,
  kTetrahedron,
  kHexahedron,
  kVoxel,
  kPrism,
  kPyramid
};

constexpr std::size_t kMostCellCorners = 8;

// The number of corners; 0: any.
std::size_t corner_count(CellShape shape);

// The simplices of one cell: `count` of `dimension`, the corners of each as numbers of corners of the cell.
struct CellDivision {
  std::size_t dimension = 0, count = 0;
  std::array<std::uint8_t, 24> corners{};
};

// REQUIRES: a shape with a fixed number of corners, and that number of them.
CellDivision divide_cell(CellShape shape, std::span<const VertexId> corners);

}  // namespace reeb::io
