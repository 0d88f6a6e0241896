// The contours that cut a loop of the Reeb graph, found in a patch around the two nodes of its pair.
//
// A loop (v, y) runs through two components of the open interlevel set between v and y. A contour cuts it if every way
// from v to y within one component crosses that contour. Other contours there bound discs, or cut other loops.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libreeb/defects/odd_cycle.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb {

// Where the curve that cuts the loop ends.
enum class ContourEnd {
  kCloses,    // in the patch
  kBoundary,  // ends at a boundary of the mesh
  kRim,       // leaves the patch
};

// Where a curve is.
struct CurvePlace {
  std::array<Point, 2> box{};
  Point center{};  // the mean of its points, within the box
};
// REQUIRES: at least one point.
CurvePlace curve_place(std::span<const Point> points);

// Every closed path that crosses it an odd number of times separates nothing.
struct LoopContour {
  Crossings crossings;
  std::vector<std::uint32_t> gates;                         // each such path has one of these vertices
  double length = std::numeric_limits<double>::infinity();  // if it does not leave the patch
  ContourEnd end = ContourEnd::kCloses;
  std::uint32_t triangles = 0;  // that it crosses
  CurvePlace place;             // if it does not leave the patch
};

// The nodes of a loop in a patch. In the Reeb graph as a whole, `lo_divides`: exactly two arcs lead up from lo;
// `hi_joins`: exactly two lead down from hi. Then both of them lead to the other node.
struct LoopNodes {
  std::uint32_t lo = 0, hi = 0;
  bool lo_divides = false, hi_joins = false;
};

// The shortest contour that closes (or, if there is none, ends at a boundary), of those at some levels between lo and
// hi. If there is none either: at a few levels all that is known to belong to one of the two components, as far as the
// patch shows it; edges of which that is not known are barred. Paths that leave the patch may come back anywhere but at
// lo and hi. REQUIRES: values has the function at each vertex of the patch; lo is below hi in the total order. TIME:
// O(n log n) for n triangles, most of which are at few of the levels.
std::vector<LoopContour> loop_contours(const SurfacePatch& patch, std::span<const double> values,
                                       const LoopNodes& nodes);

}  // namespace reeb
