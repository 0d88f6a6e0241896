#include "libreeb/defects/loop_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libreeb/defects/curve_length.h"
#include "libreeb/defects/loop_contours.h"

namespace reeb {
namespace {

std::uint32_t triangles_passed(const SurfacePatch& patch, const ClosedPath& path, const Crossings& crossings) {
  if (!crossings.empty()) return static_cast<std::uint32_t>(std::count(crossings.begin(), crossings.end(), 1));
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i < path.vertices.size(); ++i) {
    const std::uint32_t e = patch.edge_between(path.vertices[i], path.vertices[(i + 1) % path.vertices.size()]);
    const auto at = patch.triangles_at_edge(e);
    triangles.insert(triangles.end(), at.begin(), at.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return static_cast<std::uint32_t>(std::unique(triangles.begin(), triangles.end()) - triangles.begin());
}

LoopCurve curve_along(const SurfacePatch& patch, ClosedPath path) {
  LoopCurve curve;
  if (auto left = left_of(patch, path)) curve.crossings = std::move(*left);
  curve.triangles = triangles_passed(patch, path, curve.crossings);
  curve.length = curve.crossings.empty() ? path.length : tight_length(patch, path);
  curve.path = std::move(path);
  return curve;
}

}  // namespace

const char* name_of(DefectKind kind) {
  constexpr const char* kNames[] = {"handle", "tunnel", "unclear"};
  return kNames[static_cast<std::size_t>(kind)];
}

LoopCurves loop_curves(const SurfacePatch& patch, std::span<const double> values, std::uint32_t v, std::uint32_t y) {
  LoopCurves curves;
  const std::vector<LoopContour> contours = loop_contours(patch, values, v, y);
  ClosedPath shortest;
  for (const LoopContour& contour : contours)
    if (ClosedPath path = shortest_odd_cycle(patch, contour.crossings, contour.gates); path.length < shortest.length)
      shortest = std::move(path);
  if (shortest.exists()) {
    curves.cycle = curve_along(patch, std::move(shortest));
    if (!curves.cycle.crossings.empty())
      if (ClosedPath path = shortest_odd_cycle(patch, curves.cycle.crossings, curves.cycle.path.vertices);
          path.exists())
        curves.contour = curve_along(patch, std::move(path));
  }
  // The contour closes here and the cycle elsewhere: then a part of the cycle will do.
  if (!curves.cycle.path.exists() && !contours.empty() && contours[0].end == ContourEnd::kCloses)
    if (const ClosedPath arc = shortest_odd_arc(patch, contours[0].crossings); arc.exists())
      if (const auto left = left_of_arc(patch, arc))
        if (ClosedPath path = shortest_odd_cycle(patch, *left, arc.vertices); path.exists())
          curves.contour = curve_along(patch, std::move(path));
  if (!contours.empty() && contours[0].end != ContourEnd::kRim && contours[0].length < curves.contour.length) {
    curves.contour.length = contours[0].length;
    if (!curves.contour.path.exists()) curves.contour.triangles = contours[0].triangles;
  }
  return curves;
}

DefectKind kind_of(const SurfacePatch& patch, const LoopCurve& curve, bool inwards) {
  if (curve.crossings.empty()) return DefectKind::kUnclear;
  Point center{};
  const auto& vertices = curve.path.vertices;
  for (const std::uint32_t x : vertices)
    for (std::size_t k = 0; k < 3; ++k) center[k] += patch.position(x)[k] / static_cast<double>(vertices.size());
  double sum = 0;
  std::vector<std::uint32_t> around;
  for (const std::uint32_t x : vertices) {
    around.clear();
    for (const std::uint32_t e : patch.edges_at(x)) {
      const auto at = patch.triangles_at_edge(e);
      around.insert(around.end(), at.begin(), at.end());
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    Point normal{};
    for (const std::uint32_t t : around) {
      const Point n = patch.normal(t);
      for (std::size_t k = 0; k < 3; ++k) normal[k] += n[k];
    }
    const double size = std::sqrt(dot(normal, normal));
    if (size > 0) sum += dot(normal, center - patch.position(x)) / size;
  }
  if (inwards) sum = -sum;
  return sum > 0 ? DefectKind::kTunnel : sum < 0 ? DefectKind::kHandle : DefectKind::kUnclear;
}

}  // namespace reeb
