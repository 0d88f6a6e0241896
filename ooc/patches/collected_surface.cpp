#include "ooc/patches/collected_surface.h"

#include <algorithm>
#include <utility>

#include "libreeb/base/flat_map.h"

namespace reeb::ooc {

CollectedSurface::CollectedSurface(SurfaceContent content) : content_(std::move(content)) {
  const auto& triangles = content_.triangles;
  first_.assign(content_.vertices.size() + 1, 0);
  for (const auto& triangle : triangles)
    for (const std::uint32_t v : triangle) ++first_[v];
  std::uint32_t end = 0;
  for (std::uint32_t& first : first_) first = end += first;
  at_.resize(3 * triangles.size());
  for (auto t = static_cast<std::uint32_t>(triangles.size()); t-- > 0;)
    for (const std::uint32_t v : triangles[t]) at_[--first_[v]] = t;
}

CollectedSurface::Patch CollectedSurface::cut(std::span<const VertexId> seeds, std::span<const Ball> balls,
                                              std::size_t most_vertices) const {
  const auto& vertices = content_.vertices;
  const auto& positions = content_.positions;
  const auto& values = content_.values;
  const auto& whole = content_.whole;
  const auto& triangles = content_.triangles;
  // Of each vertex that was looked at: whether it is in the balls, then its place in the patch.
  constexpr std::uint32_t kOutside = SurfacePatch::kNone, kInside = kOutside - 1;
  FlatMap seen;
  std::vector<std::uint32_t> places, members, cut_off;
  bool limited = false;
  const auto place = [&](std::uint32_t v) -> std::uint32_t& {
    const std::uint32_t i = seen.find_or_insert(v, static_cast<std::uint32_t>(places.size()));
    if (i == places.size())
      places.push_back(std::ranges::any_of(balls, [&](const Ball& ball) { return ball.contains(positions[v]); })
                           ? kInside
                           : kOutside);
    return places[i];
  };
  const auto take = [&](std::uint32_t v) {
    if (place(v) != kInside) return place(v) != kOutside;
    if (members.size() >= most_vertices) {
      limited = true;
      return false;
    }
    place(v) = static_cast<std::uint32_t>(members.size());
    members.push_back(v);
    return true;
  };
  for (const VertexId seed : seeds)
    if (const auto it = std::ranges::lower_bound(vertices, seed); it != vertices.end() && *it == seed)
      take(static_cast<std::uint32_t>(it - vertices.begin()));
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::uint32_t member = members[i];
    bool all = true;
    for (const std::uint32_t t : triangles_at(member)) {
      const auto& corners = triangles[t];
      // What leads out of the balls may not be here.
      if (std::ranges::any_of(corners, [&](std::uint32_t v) { return place(v) == kOutside; }))
        all = false;
      else
        for (const std::uint32_t v : corners)
          if (!take(v)) all = false;
    }
    if (!all) cut_off.push_back(member);
  }
  std::sort(members.begin(), members.end());
  for (std::uint32_t i = 0; i < members.size(); ++i) place(members[i]) = i;

  PatchContent result;
  Patch patch{SurfacePatch({}), std::vector<std::vector<double>>(values.size()), limited};
  result.vertices.reserve(members.size());
  result.positions.reserve(members.size());
  result.whole.reserve(members.size());
  for (auto& of_function : patch.values) of_function.reserve(members.size());
  for (const std::uint32_t v : members) {
    result.vertices.push_back(vertices[v]);
    result.positions.push_back(positions[v]);
    result.whole.push_back(whole[v]);
    for (std::size_t f = 0; f < values.size(); ++f) patch.values[f].push_back(values[f][v]);
  }
  for (const std::uint32_t v : cut_off) result.whole[place(v)] = 0;
  const auto corner_set = [](std::array<std::uint32_t, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  // Each triangle at its lowest corner.
  result.triangles.reserve(2 * members.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(result.triangles.size());
    for (const std::uint32_t t : triangles_at(members[i])) {
      const auto& corners = triangles[t];
      if (std::ranges::min(corners) != members[i]) continue;
      std::array<std::uint32_t, 3> local{};
      for (std::size_t c = 0; c < 3; ++c) local[c] = place(corners[c]);
      if (std::ranges::any_of(local, [](std::uint32_t at) { return at >= kInside; })) continue;
      // A repeated triangle changes nothing.
      if (std::none_of(result.triangles.begin() + begin, result.triangles.end(),
                       [&](const auto& other) { return corner_set(other) == corner_set(local); }))
        result.triangles.push_back(local);
    }
  }
  patch.surface = SurfacePatch(std::move(result));
  return patch;
}

}  // namespace reeb::ooc
