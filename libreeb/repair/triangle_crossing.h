// Whether two triangles of a surface meet in more than the corners that they share.
#pragma once

#include <array>
#include <cstdint>

#include "libreeb/graph/settled_node.h"

namespace reeb {

// A triangle with the numbers of its corners: equal numbers are one vertex.
struct PlacedTriangle {
  std::array<std::uint32_t, 3> corners{};
  std::array<Point, 3> points{};
};

// Whether the triangle has no area, exactly.
bool is_flat(const PlacedTriangle& triangle);

// Whether they have a point in common that is not on what they share: a vertex, or an edge. Triangles with the same
// corners cross. Exact: touching counts. A triangle without area crosses nothing.
bool triangles_cross(const PlacedTriangle& s, const PlacedTriangle& t);

}  // namespace reeb
