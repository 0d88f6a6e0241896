// The contours that cut a loop of the Reeb graph, found in a patch around the two nodes of its pair.
//
// A loop (v, y) runs through two components of the open interlevel set between v and y. A contour cuts it if every way
// from v to y within one component crosses that contour. Other contours there bound discs, or cut other loops.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libreeb/defects/odd_cycle.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb {

// What is known of the contour outside the patch decides how far it can be trusted.
enum class ContourEnd {
  kCloses,    // in the patch
  kBoundary,  // ends at a boundary of the mesh
  kRim,       // leaves the patch
};

struct LoopContour {
  Crossings crossings;
  std::vector<std::uint32_t> gates;                         // the lower ends of the edges that it crosses
  double length = std::numeric_limits<double>::infinity();  // of its part in the patch
  ContourEnd end = ContourEnd::kCloses;
  std::uint32_t triangles = 0;  // that it crosses
};

// The shortest contour that closes (or, if there is none, ends at a boundary), of those at some levels between v and y.
// If there is none either, a few that leave the patch. Paths that leave the patch may come back anywhere but at v and
// y. REQUIRES: values has the function at each vertex of the patch; v is below y in the total order. TIME: O(n log n)
// for n triangles, most of which are at few of the levels.
std::vector<LoopContour> loop_contours(const SurfacePatch& patch, std::span<const double> values, std::uint32_t v,
                                       std::uint32_t y);

}  // namespace reeb
