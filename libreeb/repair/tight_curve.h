// A closed curve along edges, pulled tight across triangles.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/repair/triangle_split.h"

namespace reeb {

struct TightCurve {
  std::vector<std::uint32_t> curve;  // along edges of the patch as it is now
  double length = 0;
  PatchSplit split;
};

// The curve can be moved on the surface to a shorter one through triangles: the shortest one within three rings of
// triangles that uses corners and five places on each edge. If that is shorter than `most` times the curve, divides
// the triangles along it; else the patch stays as it is. Nothing, too, where the rings are no closed band.
// TIME: one search of the rings; a dozen finer ones if it is promising. `float32`: as in TriangleSplit.
std::optional<TightCurve> pull_tight(EditablePatch& patch, std::span<const std::uint32_t> curve, double most,
                                     bool float32);

}  // namespace reeb
