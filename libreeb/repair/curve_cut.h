// Cuts a surface along a closed curve, removes a band of triangles on one side of it, and closes both rims. One handle
// or tunnel less is left. Or closes one boundary.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/repair/editable_patch.h"

namespace reeb {

struct CutOptions {
  bool float32 = false;  // positions of new vertices are float32 numbers
};

struct Cut {
  bool done = false;
  std::string why;                       // it was not done
  bool too_small = false;                // the reason may be that the patch ends there
  std::uint64_t removed = 0, added = 0;  // triangles
  double volume = 0;                     // between the surface before and after, along its triangles' normals
  // Whether a way from one side to the other is in the patch. If not, the curve may divide the surface.
  bool connected = false;
  std::vector<std::uint32_t> first_side, second_side;  // the vertices of the rims
};

// `curve`: vertices of the patch, each joined with the next by an edge, and the last with the first. The patch stays as
// it was if nothing is done: if the curve is not on the surface any more, has no two sides, has not enough room, or if
// every filling would cross the surface. Several bands and fillings are tried; then the triangles at the curve are
// divided and they are tried again. The result is checked: it is a manifold there, its Euler characteristic is greater
// by two, and no new triangle meets another one but at common corners and edges.
Cut cut_along(EditablePatch& patch, std::span<const std::uint32_t> curve, const CutOptions& options);

// `rim`: the vertices of one boundary, in order.
Cut close_boundary(EditablePatch& patch, std::span<const std::uint32_t> rim, const CutOptions& options);

}  // namespace reeb
