// A file of VTK as its header and an index of its arrays describe it: points, cells, and values at points.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/cells/cell_division.h"
#include "io/cells/point_array.h"
#include "io/file/content_source.h"
#include "io/vtk/number_place.h"

namespace reeb::io {

// How the nodes of a list of cells are stored.
enum class CellLayout : std::uint8_t {
  kCounted,         // each cell is the number of its nodes, then they
  kOffsets,         // all nodes in one array, and the end of each cell in another
  kOffsetsFromZero  // the same, but the ends begin with a 0
};

struct CellList {
  std::uint64_t count = 0;
  CellLayout layout = CellLayout::kCounted;
  std::uint64_t node_numbers = 0;  // in the array `nodes`; for kOffsets not known
  NumberPlace nodes, offsets, types;
  bool has_types = false;  // else all are of this shape
  CellShape shape = CellShape::kPolygon;
};

struct PlacedPointArray : PointArray {
  NumberPlace place;
};

// Vertices of a piece are numbered from 0.
struct GridPiece {
  std::uint64_t points = 0;
  NumberPlace coordinates;  // three for each
  std::vector<CellList> cells;
  std::vector<PlacedPointArray> arrays;
};

struct GridFile {
  std::string format;  // as MeshInfo
  std::vector<GridPiece> pieces;
  bool has_inner_nodes = false;    // there are higher-order cells
  bool has_later_steps = false;    // there are arrays of other time steps than the first, which are left out
  std::uint64_t packed_bytes = 0;  // of the file, if its content was unpacked to another one; else 0
};

}  // namespace reeb::io
