// The two curves of a loop of the Reeb graph on the surface, and the kind of the defect that it may be.
//
// A loop stands for two classes of closed curves that cross an odd number of times, so that neither separates: contours
// and cycles. Cutting the surface along a curve of either class and closing both rims lowers the genus by one.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libreeb/defects/loop_contours.h"
#include "libreeb/defects/odd_cycle.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb {

enum class DefectKind : std::uint8_t { kHandle, kTunnel, kUnclear };
const char* name_of(DefectKind kind);
// What it is if the surface is turned inside out.
inline DefectKind opposite(DefectKind kind) {
  if (kind == DefectKind::kUnclear) return kind;
  return kind == DefectKind::kHandle ? DefectKind::kTunnel : DefectKind::kHandle;
}

struct LoopCurve {
  ClosedPath path;      // the shortest closed path along edges; none if it leaves the patch
  Crossings crossings;  // the edges to its left; empty if it meets a boundary, or no oriented manifold
  double length = std::numeric_limits<double>::infinity();  // that of the path pulled tight, or of a shorter contour
  std::uint32_t triangles = 0;                              // that the curve passes
  CurvePlace place;                                         // of the path; of a contour that has none
  bool found() const { return length < std::numeric_limits<double>::infinity(); }
};

struct LoopCurves {
  LoopCurve contour, cycle;

  // The curve of the defect: the shorter one of those that have a path.
  const LoopCurve& shorter() const {
    if (!contour.path.exists()) return cycle;
    return !cycle.path.exists() || contour.length < cycle.length ? contour : cycle;
  }
};

// What is found separates nothing: each curve crosses one that closes an odd number of times, in the patch or, as the
// graph tells, outside it. At boundaries that is not so sure.
// Paths longer than four fifths of `longest` may be missed.
// REQUIRES: values has the function at each vertex of the patch; lo is below hi in the total order; both are whole.
// TIME: O(n log n) for n triangles, for each edge that the contour crosses; mostly far less, since a search ends where
//       its path would be longer than the best so far.
LoopCurves loop_curves(const SurfacePatch& patch, std::span<const double> values, const LoopNodes& nodes,
                       double longest = std::numeric_limits<double>::infinity());

// REQUIRES: the path is simple, and its vertices are whole.
LoopCurve curve_along(const SurfacePatch& patch, ClosedPath path);

// A tunnel if the disc of the curve lies outside the solid, a handle if it lies inside: by the sign of the sum of
// n·(m − p) over the vertices p of the curve, with their outward normals n and their mean m. `inwards`: the oriented
// triangles of the patch have their normals inside.
DefectKind kind_of(const SurfacePatch& patch, const LoopCurve& curve, bool inwards);

}  // namespace reeb
