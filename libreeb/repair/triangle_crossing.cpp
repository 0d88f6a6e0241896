#include "libreeb/repair/triangle_crossing.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "libreeb/repair/exact_sign.h"

namespace reeb {
namespace {

using Corners = std::array<Point, 3>;

// The coordinate without which the triangle still has an area; nothing if it has none.
std::optional<std::size_t> plane_of(const Corners& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (turn_without(k, t[0], t[1], t[2]) != 0) return k;
  return std::nullopt;
}

// For a point in the plane of the triangle.
bool holds(const Corners& t, std::size_t plane, const Point& p) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int turn = turn_without(plane, t[i], t[(i + 1) % 3], p);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

// For two segments in one plane; the ends belong to them.
bool segments_meet(std::size_t plane, const Point& p, const Point& q, const Point& a, const Point& b) {
  const int pa = turn_without(plane, p, q, a), pb = turn_without(plane, p, q, b);
  const int ap = turn_without(plane, a, b, p), aq = turn_without(plane, a, b, q);
  if (pa * pb > 0 || ap * aq > 0) return false;
  if (pa != 0 || pb != 0 || ap != 0 || aq != 0) return true;
  for (std::size_t k = 0; k < 3; ++k)  // on one line
    if (std::max(p[k], q[k]) < std::min(a[k], b[k]) || std::max(a[k], b[k]) < std::min(p[k], q[k])) return false;
  return true;
}

// Whether the segment and the triangle, which has an area, have a point in common.
bool segment_meets(const Corners& t, std::size_t plane, const Point& p, const Point& q) {
  const int at_p = side_of_plane(t[0], t[1], t[2], p), at_q = side_of_plane(t[0], t[1], t[2], q);
  if (at_p * at_q > 0) return false;
  if (at_p == 0 && at_q == 0) {
    if (holds(t, plane, p) || holds(t, plane, q)) return true;
    for (std::size_t i = 0; i < 3; ++i)
      if (segments_meet(plane, p, q, t[i], t[(i + 1) % 3])) return true;
    return false;
  }
  if (at_p == 0) return holds(t, plane, p);
  if (at_q == 0) return holds(t, plane, q);
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = side_of_plane(p, q, t[i], t[(i + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
  }
  return !(left && right);
}

}  // namespace

bool is_flat(const PlacedTriangle& triangle) { return !plane_of(triangle.points); }

bool triangles_cross(const PlacedTriangle& s, const PlacedTriangle& t) {
  // The corners that both share, first.
  std::array<std::size_t, 3> of_s{}, of_t{};
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (s.corners[i] == t.corners[j]) {
        of_s[shared] = i;
        of_t[shared] = j;
        ++shared;
        break;
      }
  if (shared == 3) return true;
  const auto plane_s = plane_of(s.points), plane_t = plane_of(t.points);
  if (!plane_s || !plane_t) return false;
  if (shared == 2) {
    // They overlap if one lies on the other.
    const std::size_t i = 3 - of_s[0] - of_s[1], j = 3 - of_t[0] - of_t[1];
    const Point &a = s.points[of_s[0]], &b = s.points[of_s[1]], &c = s.points[i], &d = t.points[j];
    return side_of_plane(a, b, c, d) == 0 && turn_without(*plane_s, a, b, c) * turn_without(*plane_s, a, b, d) > 0;
  }
  if (shared == 1) {
    // What they have in common begins at the shared corner and ends at an opposite edge.
    const std::size_t i = of_s[0], j = of_t[0];
    return segment_meets(t.points, *plane_t, s.points[(i + 1) % 3], s.points[(i + 2) % 3]) ||
           segment_meets(s.points, *plane_s, t.points[(j + 1) % 3], t.points[(j + 2) % 3]);
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (segment_meets(t.points, *plane_t, s.points[i], s.points[(i + 1) % 3]) ||
        segment_meets(s.points, *plane_s, t.points[i], t.points[(i + 1) % 3]))
      return true;
  return false;
}

}  // namespace reeb
