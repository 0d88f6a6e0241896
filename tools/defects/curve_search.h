// The curves of loops, found in patches of the mesh around the nodes of their pairs.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/defects/loop_contours.h"
#include "libreeb/defects/loop_curves.h"
#include "libreeb/defects/surface_patch.h"
#include "tools/defects/loop_list.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// A curve by vertices of the mesh.
struct FoundCurve {
  double length = std::numeric_limits<double>::infinity();
  std::vector<VertexId> path;  // empty if the curve is a contour that is not along edges
  CurvePlace place;
  std::uint32_t triangles = 0;
  bool closed = false;  // on an oriented manifold, away from boundaries
  DefectKind kind = DefectKind::kUnclear;
  bool inwards = false;  // the oriented triangles of its component have their normals inside
  bool found() const { return length < std::numeric_limits<double>::infinity(); }
};

struct FoundCurves {
  FoundCurve contour, cycle;
};

struct SearchOptions {
  unsigned threads = 0;
  const io::TempDir* temp = nullptr;
  MemoryBudget* budget = nullptr;                       // what patches are reserved from
  std::uint64_t patch_bytes = std::uint64_t{24} << 20;  // of the surface that is in memory at a time, roughly
  std::function<void(std::uint64_t done, std::uint64_t total, std::uint64_t triangles)> progress{};
};

// How patches are measured. An edge of this mesh is `edge` long, roughly.
struct PatchScale {
  double edge = 0, size = 0;                            // of an edge, and of the whole mesh
  static constexpr std::size_t kMostVertices = 10'000;  // of a patch
  // Curves that are longer are no small defects: nothing looks for them.
  double longest() const { return 100 * edge; }
  // Vertices in a ball, roughly: those of two sheets.
  double vertices(double radius) const;
  // Of the ball that has this number.
  double radius(double vertices) const;
  // Of a mesh that is in memory, for searches and comparisons.
  static constexpr std::uint64_t kBytesPerVertex = 120;
  // Also if the square of the radius is beyond the doubles: then no distance can be compared with it.
  bool too_large(double radius) const {
    return vertices(radius) > kMostVertices || radius > 2 * size || !std::isfinite(radius * radius);
  }
};
PatchScale scale_of(const LoopList& list);

struct LoopCurvesFound {
  // Of each loop, those of its patches, the smaller ones first: in a larger patch, a curve of another defect that the
  // loop runs through can be shorter.
  std::vector<std::vector<FoundCurves>> curves;
  PatchScale scale;    // with edges as measured near the loops
  Reservation memory;  // of the curves
};

// Whether the oriented triangles near the vertex, the highest of its component along a coordinate, have their normals
// inside. What is cut off by a level below the top is closed but for a flat disc, so its normals add up to that of the
// disc. The cap is as large as the patch allows: noise can fold the triangles right at the top. If it is all of a
// component that is closed or has small holes, its normals add up to little, and the sign of its volume tells; then
// `top` can be any vertex.
// Nothing if the patch is too small to tell.
std::optional<bool> is_inwards(const SurfacePatch& patch, std::uint32_t top, std::size_t axis);
// The curve by the vertices of the mesh; its kind as if normals were outside.
FoundCurve in_mesh(const SurfacePatch& patch, const LoopCurve& curve);
// For a component whose normals are inside.
void turn(FoundCurve& curve);

// Reads the mesh about as often as a small patch must be doubled until it holds the curves of the largest loop whose
// patch is not too large. Each reading collects the patches of all loops that need one, in a temporary file; loops near
// each other are searched together. What is found does not depend on how many these are.
// MEMORY: options.patch_bytes, what ooc::DividedSurface says, and the patch that a thread searches: all from the
// budget. THROWS: Error{kBadInput} if the loops are not those of this mesh.
LoopCurvesFound find_curves(const ValuedMesh& mesh, const LoopList& list, const PatchScale& scale,
                            const SearchOptions& options);

}  // namespace reeb::tools
