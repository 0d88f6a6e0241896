// On which side a point lies, decided exactly for any coordinates that are double numbers.
#pragma once

#include <cstddef>

#include "libreeb/graph/settled_node.h"

namespace reeb {

// The sign (-1, 0, 1) of (b - a) x (c - a) . (d - a): positive if a, b, c run counterclockwise as seen from d, 0 if all
// four are in one plane.
// REQUIRES: no product of three differences of coordinates overflows or underflows.
int side_of_plane(const Point& a, const Point& b, const Point& c, const Point& d);

// The sign of the area of the triangle a, b, c when coordinate `dropped` is left out: positive if it runs
// counterclockwise in the two others, taken in cyclic order.
int turn_without(std::size_t dropped, const Point& a, const Point& b, const Point& c);

}  // namespace reeb
