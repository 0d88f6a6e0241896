#include "ooc/patches/collected_surface.h"

#include <algorithm>
#include <utility>

#include "libreeb/containers/flat_map.h"

namespace reeb::ooc {
namespace {

// Of each vertex that was looked at: whether it is in the balls, then its place in the patch.
constexpr std::uint32_t kOutside = SurfacePatch::kNone, kInside = kOutside - 1;

}  // namespace

// The vertices of a patch.
struct CollectedSurface::Chosen {
  std::vector<std::uint32_t> members;  // ascending
  std::vector<std::uint32_t> cut_off;  // members with triangles that are not in the patch
  bool limited = false;
  FlatMap seen;  // from vertices to their entries in `places`
  std::vector<std::uint32_t> places;

  std::uint32_t place(std::uint32_t v) const {
    const std::uint32_t i = seen.find(v);
    return i == FlatMap::kNone ? kOutside : places[i];
  }
};

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
                                              std::size_t most_vertices,
                                              const std::function<void(std::size_t)>& chosen) const {
  const Chosen vertices = choose(seeds, balls, most_vertices);
  if (chosen) chosen(vertices.members.size());
  return copy(vertices);
}

CollectedSurface::Chosen CollectedSurface::choose(std::span<const VertexId> seeds, std::span<const Ball> balls,
                                                  std::size_t most_vertices) const {
  const auto& vertices = content_.vertices;
  const auto& positions = content_.positions;
  Chosen chosen;
  auto& members = chosen.members;
  auto& places = chosen.places;
  const auto place = [&](std::uint32_t v) -> std::uint32_t& {
    const std::uint32_t i = chosen.seen.find_or_insert(v, static_cast<std::uint32_t>(places.size()));
    if (i == places.size())
      places.push_back(std::ranges::any_of(balls, [&](const Ball& ball) { return ball.contains(positions[v]); })
                           ? kInside
                           : kOutside);
    return places[i];
  };
  const auto take = [&](std::uint32_t v) {
    if (place(v) != kInside) return place(v) != kOutside;
    if (members.size() >= most_vertices) {
      chosen.limited = true;
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
      const auto& corners = content_.triangles[t];
      // What leads out of the balls may not be here.
      if (std::ranges::any_of(corners, [&](std::uint32_t v) { return place(v) == kOutside; }))
        all = false;
      else
        for (const std::uint32_t v : corners)
          if (!take(v)) all = false;
    }
    if (!all) chosen.cut_off.push_back(member);
  }
  std::sort(members.begin(), members.end());
  for (std::uint32_t i = 0; i < members.size(); ++i) place(members[i]) = i;
  return chosen;
}

CollectedSurface::Patch CollectedSurface::copy(const Chosen& chosen) const {
  const auto& values = content_.values;
  const auto& members = chosen.members;
  PatchContent result;
  Patch patch{SurfacePatch({}), std::vector<std::vector<double>>(values.size()), chosen.limited};
  result.vertices.reserve(members.size());
  result.positions.reserve(members.size());
  result.whole.reserve(members.size());
  for (auto& of_function : patch.values) of_function.reserve(members.size());
  for (const std::uint32_t v : members) {
    result.vertices.push_back(content_.vertices[v]);
    result.positions.push_back(content_.positions[v]);
    result.whole.push_back(content_.whole[v]);
    for (std::size_t f = 0; f < values.size(); ++f) patch.values[f].push_back(values[f][v]);
  }
  for (const std::uint32_t v : chosen.cut_off) result.whole[chosen.place(v)] = 0;
  const auto corner_set = [](std::array<std::uint32_t, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  // Each triangle at its lowest corner.
  result.triangles.reserve(2 * members.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(result.triangles.size());
    for (const std::uint32_t t : triangles_at(members[i])) {
      const auto& corners = content_.triangles[t];
      if (std::ranges::min(corners) != members[i]) continue;
      std::array<std::uint32_t, 3> local{};
      for (std::size_t c = 0; c < 3; ++c) local[c] = chosen.place(corners[c]);
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
