#include "libreeb/repair/triangle_split.h"

#include <algorithm>
#include <optional>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/nearest_float32.h"

namespace reeb {

void undo_split(EditablePatch& patch, const PatchSplit& split) {
  patch.take_back(split.vertices, split.triangles);
  for (const std::uint32_t t : split.removed) patch.restore(t);
}

TriangleSplit::TriangleSplit(EditablePatch& patch, bool float32) : patch_(patch), float32_(float32) {
  split_.vertices = patch.vertex_count();
  split_.triangles = patch.triangle_count();
}

std::uint32_t TriangleSplit::point_on(std::uint32_t a, std::uint32_t b, int twelfths) {
  if (a > b) {
    std::swap(a, b);
    twelfths = 12 - twelfths;
  }
  auto& on_edge = points_[{a, b}];
  if (const auto it = on_edge.find(twelfths); it != on_edge.end()) return it->second;
  const Point &p = patch_.position(a), &q = patch_.position(b);
  EditablePatch::Vertex vertex{VertexId::none(), {}, true, false, {a, twelfths < 6 ? a : b, b}};
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = p[k] + (q[k] - p[k]) * (twelfths / 12.0);
    vertex.position[k] = float32_ ? nearest_float32(x) : x;
  }
  return on_edge[twelfths] = patch_.add_vertex(vertex);
}

PatchSplit TriangleSplit::run() {
  for (const auto& [edge, on_edge] : points_)
    patch_.for_each_at_edge(edge.first, edge.second, [&](std::uint32_t t) { split_.removed.push_back(t); });
  std::sort(split_.removed.begin(), split_.removed.end());
  split_.removed.erase(std::unique(split_.removed.begin(), split_.removed.end()), split_.removed.end());
  for (const std::uint32_t t : split_.removed) patch_.remove(t);
  for (const std::uint32_t t : split_.removed) divide(t);
  return std::move(split_);
}

void TriangleSplit::divide(std::uint32_t triangle) {
  const EditablePatch::Corners corners = patch_.triangle(triangle).corners;
  constexpr std::array<std::array<int, 2>, 3> kAt = {{{0, 0}, {12, 0}, {0, 12}}};
  std::vector<std::vector<Place>> polygons(1);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::uint32_t a = corners[i], b = corners[j];
    polygons[0].push_back({a, kAt[i]});
    const auto it = points_.find(std::minmax(a, b));
    if (it == points_.end()) continue;
    const std::size_t first = polygons[0].size();
    for (const auto& [twelfths, v] : it->second) {
      const int s = a < b ? twelfths : 12 - twelfths;
      polygons[0].push_back(
          {v, {kAt[i][0] + (kAt[j][0] - kAt[i][0]) * s / 12, kAt[i][1] + (kAt[j][1] - kAt[i][1]) * s / 12}});
    }
    if (a > b) std::reverse(polygons[0].begin() + static_cast<std::ptrdiff_t>(first), polygons[0].end());
  }
  if (const auto ways = ways_.find(triangle); ways != ways_.end())
    for (const auto& [a, b] : ways->second)
      for (std::size_t p = 0; p < polygons.size(); ++p) {
        const auto place_of = [&](std::uint32_t v) {
          return std::ranges::find(polygons[p], v, &Place::vertex) - polygons[p].begin();
        };
        const auto [i, j] = std::minmax({place_of(a), place_of(b)});
        const auto size = static_cast<std::ptrdiff_t>(polygons[p].size());
        if (j == size || j - i < 2 || j - i > size - 2) continue;
        std::vector<Place> other(polygons[p].begin() + i, polygons[p].begin() + j + 1);
        polygons[p].erase(polygons[p].begin() + i + 1, polygons[p].begin() + j);
        polygons.push_back(std::move(other));
        break;
      }
  for (std::vector<Place>& polygon : polygons) cut_ears(std::move(polygon));
}

// Of a convex polygon, in which some corners can be on one line.
void TriangleSplit::cut_ears(std::vector<Place> polygon) {
  const auto area = [](const Place& a, const Place& b, const Place& c) {
    return (b.at[0] - a.at[0]) * (c.at[1] - a.at[1]) - (b.at[1] - a.at[1]) * (c.at[0] - a.at[0]);
  };
  const auto total = [&] {
    int sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) sum += area(polygon[0], polygon[i], polygon[i + 1]);
    return sum;
  };
  while (polygon.size() > 3) {
    // The shortest diagonal, of those that leave something with an area on both sides.
    const int whole = total();
    std::optional<std::size_t> best;
    double best_length = 0;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Place &before = polygon[(i + n - 1) % n], &next = polygon[(i + 1) % n];
      const int ear = area(before, polygon[i], next);
      if (ear == 0 || ear == whole) continue;
      const double length = distance(patch_.position(before.vertex), patch_.position(next.vertex));
      if (best && length >= best_length) continue;
      best = i;
      best_length = length;
    }
    if (!best) return;
    const std::size_t i = *best;
    patch_.add_new({polygon[(i + n - 1) % n].vertex, polygon[i].vertex, polygon[(i + 1) % n].vertex});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
  }
  patch_.add_new({polygon[0].vertex, polygon[1].vertex, polygon[2].vertex});
}

PatchSplit make_room(EditablePatch& patch, const std::vector<std::uint32_t>& curve, bool float32) {
  std::map<std::uint32_t, std::size_t> place;
  for (std::size_t i = 0; i < curve.size(); ++i) place.emplace(curve[i], i);
  const auto on_curve = [&](std::uint32_t v) { return place.contains(v); };
  const auto is_curve_edge = [&](std::uint32_t a, std::uint32_t b) {
    const auto i = place.find(a), j = place.find(b);
    if (i == place.end() || j == place.end()) return false;
    const auto [low, high] = std::minmax(i->second, j->second);
    return high - low == 1 || (low == 0 && high + 1 == curve.size());
  };
  TriangleSplit split(patch, float32);
  // The point on the edge next to `from`, which is on the curve.
  const auto point = [&](std::uint32_t from, std::uint32_t to) {
    return split.point_on(from, to, on_curve(to) ? 4 : 6);
  };
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t v : curve) patch.for_each_at(v, [&](std::uint32_t t) { triangles.push_back(t); });
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  for (const std::uint32_t t : triangles) {
    const auto c = patch.triangle(t).corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = c[i], next = c[(i + 1) % 3], last = c[(i + 2) % 3];
      if (is_curve_edge(v, next)) {
        // A strip along this edge.
        if (!is_curve_edge(next, last) && !is_curve_edge(last, v)) split.join(t, point(v, last), point(next, last));
      } else {
        if (on_curve(v)) point(v, next);
        if (on_curve(next)) point(next, v);
        if (on_curve(v) && !is_curve_edge(v, last)) split.join(t, point(v, next), point(v, last));
      }
    }
  }
  return split.run();
}

}  // namespace reeb
