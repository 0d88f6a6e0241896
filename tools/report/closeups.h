// The surface around the first defects, small enough for a page.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "tools/defects/find_defects.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

inline constexpr std::size_t kMostCloseups = 12;

// A list of what tools/web/report/closeup.js draws, for the first rows; reads the mesh once.
//
//   size, min  of the patch's box: its largest side and its least corner, in units of the mesh
//   length, center   of the shorter curve; null, and of the two nodes, if none was found
//   places     4 numbers a vertex, base64 of 16 bits each: the position in the box, and the value in the patch
//   triangles  3 vertices a triangle, likewise, oriented
//   curve, other   the closed curves, by vertices; empty if there is none, or if it leaves the patch
//   limited    only the part of the surface nearest to the curve is in it
nlohmann::ordered_json closeups_json(const ValuedMesh& mesh, const Defects& defects);

}  // namespace reeb::tools
