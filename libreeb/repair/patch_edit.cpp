#include "libreeb/repair/patch_edit.h"

#include <algorithm>
#include <cmath>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/triangle_crossing.h"

namespace reeb {
namespace {

constexpr std::uint32_t kNone = EditablePatch::kNone;

}  // namespace

PatchEdit::PatchEdit(EditablePatch& patch, bool float32, const PatchSplit* split)
    : patch_(patch),
      float32_(float32),
      split_(split),
      vertices_(patch.vertex_count()),
      triangles_(patch.triangle_count()) {}

void PatchEdit::remove(const PatchNumbers& triangles) {
  for (const std::uint32_t t : triangles) {
    patch_.remove(t);
    removed_.push_back(t);
  }
}

void PatchEdit::undo() {
  patch_.take_back(vertices_, triangles_);
  for (const std::uint32_t t : removed_) patch_.restore(t);
}

bool PatchEdit::fill(PatchNumbers path, FillWeight weight, bool refine) {
  if (path.size() < 3 || path.size() > kMostRimVertices) return false;
  // New triangles run against their neighbours.
  std::size_t along = 0;
  const std::size_t n = path.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t t = only_at(path[i], path[(i + 1) % n]);
    if (t == kNone) return false;
    along += patch_.runs_along(t, path[i], path[(i + 1) % n]) ? 1u : 0u;
  }
  if (2 * along > n) std::reverse(path.begin(), path.end());
  const auto filling = fill_rim(rim_of(path), {weight, refine && n > kWideRim, float32_});
  if (!filling) return false;
  const auto base = static_cast<std::uint32_t>(patch_.vertex_count());
  const auto number = [&](std::uint32_t v) { return v < n ? path[v] : base + (v - static_cast<std::uint32_t>(n)); };
  for (const Filling::Vertex& vertex : filling->vertices) {
    EditablePatch::Vertex added{VertexId::none(), vertex.position, true, false, {}};
    for (std::size_t k = 0; k < 3; ++k) added.parents[k] = number(vertex.parents[k]);
    patch_.add_vertex(added);
  }
  for (const auto& c : filling->triangles) patch_.add_new({number(c[0]), number(c[1]), number(c[2])});
  return true;
}

Rim PatchEdit::rim_of(const PatchNumbers& path) const {
  const std::size_t n = path.size();
  Rim rim;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t v = path[i], next = path[(i + 1) % n];
    rim.points.push_back(patch_.position(v));
    rim.beside.push_back(patch_.position(patch_.third_corner(only_at(v, next), v, next)));
    double sum = 0;
    std::size_t count = 0;
    patch_.for_each_at(v, [&](std::uint32_t t) {
      for (const std::uint32_t w : patch_.triangle(t).corners)
        if (w != v) {
          sum += distance(patch_.position(v), patch_.position(w));
          ++count;
          if (const auto it = std::find(path.begin(), path.end(), w); it != path.end())
            if (const auto k = static_cast<std::size_t>(it - path.begin()); k > i)
              rim.joined.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
        }
    });
    rim.edge.push_back(sum / static_cast<double>(count));
  }
  std::sort(rim.joined.begin(), rim.joined.end());
  return rim;
}

std::size_t PatchEdit::removed_count() const {
  const std::size_t first = first_new();
  std::size_t count = split_ != nullptr ? split_->removed.size() : 0;
  for (const std::uint32_t t : removed_) count += t < first ? 1u : 0u;
  return count;
}

std::size_t PatchEdit::added_count() const {
  std::size_t count = 0;
  for (auto t = static_cast<std::uint32_t>(first_new()); t < patch_.triangle_count(); ++t)
    count += patch_.triangle(t).there ? 1u : 0u;
  return count;
}

PatchNumbers PatchEdit::touched() const {
  PatchNumbers result;
  const auto take = [&](std::uint32_t t) {
    for (const std::uint32_t v : patch_.triangle(t).corners) result.push_back(v);
  };
  for (const std::uint32_t t : removed_) take(t);
  if (split_ != nullptr)
    for (const std::uint32_t t : split_->removed) take(t);
  for (auto t = static_cast<std::uint32_t>(first_new()); t < patch_.triangle_count(); ++t) take(t);
  make_set(result);
  return result;
}

// Of removed triangles, or of added ones: six times the volume under them, seen from one of their corners.
double PatchEdit::volume() const {
  const PatchNumbers all = touched();
  const Point origin = patch_.position(all[0]);
  double sum = 0;
  const auto under = [&](std::uint32_t t) {
    const auto& c = patch_.triangle(t).corners;
    const Point a = patch_.position(c[0]) - origin, b = patch_.position(c[1]) - origin,
                d = patch_.position(c[2]) - origin;
    return a[0] * (b[1] * d[2] - b[2] * d[1]) + a[1] * (b[2] * d[0] - b[0] * d[2]) + a[2] * (b[0] * d[1] - b[1] * d[0]);
  };
  for (const std::uint32_t t : removed_) sum -= under(t);
  for (auto t = static_cast<std::uint32_t>(triangles_); t < patch_.triangle_count(); ++t) sum += under(t);
  return sum / 6;
}

bool PatchEdit::folds() const {
  constexpr double kMostCosine = -0.98;
  for (auto t = static_cast<std::uint32_t>(triangles_); t < patch_.triangle_count(); ++t) {
    const auto& c = patch_.triangle(t).corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t other = patch_.across(t, c[i], c[(i + 1) % 3]);
      if (other == kNone) continue;
      const Point n = normal(t), m = normal(other);
      if (dot(n, m) < kMostCosine * std::sqrt(dot(n, n) * dot(m, m))) return true;
    }
  }
  return false;
}

bool PatchEdit::crosses() const {
  const auto first = static_cast<std::uint32_t>(first_new()), end = static_cast<std::uint32_t>(patch_.triangle_count());
  if (first == end) return false;
  PointBox all = PointBox::around(patch_.placed(end - 1).points);
  std::vector<PointBox> boxes;
  for (std::uint32_t t = first; t < end; ++t) {
    const PlacedTriangle placed = patch_.placed(t);
    boxes.push_back(PointBox::around(placed.points));
    if (!patch_.triangle(t).there) continue;
    if (is_flat(placed)) return true;
    all.add(boxes.back());
  }
  // With new triangles from number `from` on.
  const auto crosses_new = [&](const PlacedTriangle& triangle, const PointBox& box, std::uint32_t from) {
    for (std::uint32_t t = from; t < end; ++t)
      if (patch_.triangle(t).there && box.meets(boxes[t - first]) && triangles_cross(triangle, patch_.placed(t)))
        return true;
    return false;
  };
  for (const PlacedTriangle& obstacle : patch_.obstacles())
    if (const PointBox box = PointBox::around(obstacle.points); box.meets(all) && crosses_new(obstacle, box, first))
      return true;
  bool found = false;
  patch_.cells().visit(all, [&](std::uint32_t u) {
    if (!patch_.triangle(u).there) return true;
    const PlacedTriangle placed = patch_.placed(u);
    const PointBox box = PointBox::around(placed.points);
    found = box.meets(all) && crosses_new(placed, box, std::max(first, u + 1));
    return !found;
  });
  return found;
}

// The parts of divided triangles are new, too.
std::size_t PatchEdit::first_new() const { return split_ != nullptr ? split_->triangles : triangles_; }

Point PatchEdit::normal(std::uint32_t t) const {
  const auto& c = patch_.triangle(t).corners;
  const Point& apex = patch_.position(c[0]);
  return cross(patch_.position(c[1]) - apex, patch_.position(c[2]) - apex);
}

// The triangle at an edge that has no other.
std::uint32_t PatchEdit::only_at(std::uint32_t a, std::uint32_t b) const {
  std::uint32_t only = kNone;
  std::size_t count = 0;
  patch_.for_each_at_edge(a, b, [&](std::uint32_t t) {
    ++count;
    only = t;
  });
  return count == 1 ? only : kNone;
}

}  // namespace reeb
