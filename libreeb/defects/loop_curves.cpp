#include "libreeb/defects/loop_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libreeb/containers/union_find.h"
#include "libreeb/defects/curve_length.h"
#include "libreeb/defects/curve_relations.h"

namespace reeb {
namespace {

std::uint32_t triangles_passed(const SurfacePatch& patch, const ClosedPath& path, const Crossings& crossings) {
  if (!crossings.empty()) return static_cast<std::uint32_t>(std::count(crossings.begin(), crossings.end(), 1));
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t e : edges_of(patch, path)) {
    const auto at = patch.triangles_at_edge(e);
    triangles.insert(triangles.end(), at.begin(), at.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return static_cast<std::uint32_t>(std::unique(triangles.begin(), triangles.end()) - triangles.begin());
}

// Whether the curve cuts off a part that stays in the patch, with boundaries of the mesh: a curve around a hole.
bool cuts_off(const SurfacePatch& patch, const ClosedPath& path) {
  std::vector<std::uint8_t> on_path(patch.edge_count(), 0);
  const std::vector<std::uint32_t> edges = edges_of(patch, path);
  for (const std::uint32_t e : edges) on_path[e] = 1;
  const std::uint32_t outside = patch.triangle_count();
  UnionFind part(outside + 1);
  for (std::uint32_t e = 0; e < patch.edge_count(); ++e) {
    if (on_path[e] != 0) continue;
    const auto at = patch.triangles_at_edge(e);
    for (const std::uint32_t t : at) part.unite(at[0], t);
    if (at.size() == 1 && patch.at_rim(e)) part.unite(at[0], outside);
  }
  return std::ranges::any_of(edges, [&](std::uint32_t e) {
    const auto at = patch.triangles_at_edge(e);
    return at.size() == 2 && part.find(at[0]) != part.find(at[1]) &&
           (part.find(at[0]) != part.find(outside) || part.find(at[1]) != part.find(outside));
  });
}

}  // namespace

LoopCurve curve_along(const SurfacePatch& patch, ClosedPath path) {
  LoopCurve curve;
  if (auto left = left_of(patch, path); left && !cuts_off(patch, path)) curve.crossings = std::move(*left);
  curve.triangles = triangles_passed(patch, path, curve.crossings);
  curve.length = curve.crossings.empty() ? path.length : tight_length(patch, path);
  std::vector<Point> points;
  for (const std::uint32_t v : path.vertices) points.push_back(patch.position(v));
  curve.place = curve_place(points);
  curve.path = std::move(path);
  return curve;
}

const char* name_of(DefectKind kind) {
  constexpr const char* kNames[] = {"handle", "tunnel", "unclear"};
  return kNames[static_cast<std::size_t>(kind)];
}

LoopCurves loop_curves(const SurfacePatch& patch, std::span<const double> values, const LoopNodes& nodes,
                       double longest) {
  LoopCurves curves;
  const std::vector<LoopContour> contours = loop_contours(patch, values, nodes);
  if (contours.empty()) return curves;
  const LoopContour& first = contours[0];
  const std::vector<std::uint8_t> inner = inner_vertices(patch);
  const auto cycle_in = [&](std::span<const std::uint8_t> allowed) {
    ClosedPath shortest;
    for (const LoopContour& contour : contours)
      if (ClosedPath path = shortest_odd_cycle(patch, contour.crossings, contour.gates, allowed, longest);
          path.length < shortest.length)
        shortest = std::move(path);
    return shortest;
  };
  // A curve away from boundaries shows what the defect is.
  if (ClosedPath path = cycle_in(inner); path.exists()) {
    curves.cycle = curve_along(patch, std::move(path));
    if (!curves.cycle.crossings.empty())
      if (ClosedPath other =
              shortest_odd_cycle(patch, curves.cycle.crossings, curves.cycle.path.vertices, inner, longest);
          other.exists())
        curves.contour = curve_along(patch, std::move(other));
    // A curve around a boundary, which the contour meets: no closed curve crosses it once.
    if (first.end == ContourEnd::kBoundary && !curves.contour.path.exists()) curves.cycle.crossings.clear();
  } else if (ClosedPath any = cycle_in(whole_vertices(patch)); any.exists()) {
    curves.cycle = curve_along(patch, std::move(any));
  }
  if (first.end != ContourEnd::kCloses) return curves;
  // The contour closes here and the cycle elsewhere: then a part of the cycle will do.
  if (!curves.cycle.path.exists())
    if (const ClosedPath arc = shortest_odd_arc(patch, first.crossings); arc.exists())
      if (const auto left = left_of_arc(patch, arc))
        if (ClosedPath path = shortest_odd_cycle(patch, *left, arc.vertices, inner, longest); path.exists())
          if (LoopCurve curve = curve_along(patch, std::move(path));
              !curve.crossings.empty() && bound_together(patch, curve.crossings, first.crossings))
            curves.contour = std::move(curve);
  if (first.length < curves.contour.length) {
    curves.contour.length = first.length;
    if (!curves.contour.path.exists()) {
      curves.contour.triangles = first.triangles;
      curves.contour.place = first.place;
    }
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
  for (const std::uint32_t x : vertices) {
    // Of the triangles at the vertex alone: on a thin wall, those around them are on its other side. Each is at two of
    // the edges.
    Point normal{};
    for (const std::uint32_t e : patch.edges_at(x))
      for (const std::uint32_t t : patch.triangles_at_edge(e)) {
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
