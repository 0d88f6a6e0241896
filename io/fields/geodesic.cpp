#include "io/fields/geodesic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace reeb::io {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The distance of corner c of a triangle to the virtual source that has the distances da and db from the corners a and
// b; infinite if the path would not cross the edge ab. `ab`, `ac` and `bc` are lengths.
double across(double da, double db, double ab, double ac, double bc) {
  if (!(ab > 0)) return kInfinite;
  // a at the origin, b on the axis, c above it, the source below.
  const double source_x = (da * da + ab * ab - db * db) / (2 * ab);
  const double below = da * da - source_x * source_x;
  if (below < 0) return kInfinite;
  const double source_y = std::sqrt(below);
  const double corner_x = (ac * ac + ab * ab - bc * bc) / (2 * ab);
  const double corner_y = std::sqrt(std::max(0.0, ac * ac - corner_x * corner_x));
  if (!(source_y + corner_y > 0)) return kInfinite;
  const double crossing = source_x + (corner_x - source_x) * (source_y / (source_y + corner_y));
  if (crossing < 0 || crossing > ab) return kInfinite;
  return std::hypot(corner_x - source_x, corner_y + source_y);
}

// An update of a corner over an edge that need not be of the mesh.
struct Crossing {
  std::uint32_t corner = 0;
  double to_first = 0, to_second = 0, between = 0;  // lengths
};

// At an obtuse corner a front may come first, before both ends of the edge opposite to it. So the triangles beyond that
// edge are unfolded into the plane, one after the other, until a vertex of them divides the angle into two acute ones
// (R. Kimmel, J. Sethian: Computing geodesic paths on manifolds, PNAS 1998).
struct Unfolded {
  std::vector<Crossing> crossings;
  std::vector<std::array<std::uint32_t, 2>> ends;  // of the edge that is crossed
};

struct PlanePoint {
  double x = 0, y = 0;
};
double dot(const PlanePoint& p, const PlanePoint& q) { return p.x * q.x + p.y * q.y; }
double cross(const PlanePoint& p, const PlanePoint& q) { return p.x * q.y - p.y * q.x; }
double length(const PlanePoint& p, const PlanePoint& q = {}) { return std::hypot(p.x - q.x, p.y - q.y); }

// A vertex of a triangle that was unfolded.
struct PlaneVertex {
  std::uint32_t vertex = 0;
  PlanePoint at;
};

// The third vertex of a triangle over the edge from `left` to `right`, on its right side.
PlanePoint beyond(const PlanePoint& left, const PlanePoint& right, double to_left, double to_right) {
  const double edge = length(left, right);
  if (!(edge > 0)) return left;
  const double along = (to_left * to_left + edge * edge - to_right * to_right) / (2 * edge);
  const double away = std::sqrt(std::max(0.0, to_left * to_left - along * along));
  const PlanePoint u{(right.x - left.x) / edge, (right.y - left.y) / edge};
  return {left.x + u.x * along + u.y * away, left.y + u.y * along - u.x * away};
}

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

// The third vertex of the other triangle at an edge; kNoVertex if there is none, or more than one.
std::uint32_t far_vertex(const WholeComplex& complex, const Incidence& triangles, std::uint32_t a, std::uint32_t b,
                         std::uint32_t near) {
  // A vertex in the middle of a fan has far more triangles than the ones around it.
  if (triangles.of(b).size() < triangles.of(a).size()) std::swap(a, b);
  std::uint32_t far = kNoVertex;
  for (const std::uint32_t t : triangles.of(a)) {
    const auto& corners = complex.triangles[t];
    if (corners[0] != b && corners[1] != b && corners[2] != b) continue;
    const std::uint32_t third = corners[0] ^ corners[1] ^ corners[2] ^ a ^ b;
    if (third == near) continue;
    if (far != kNoVertex) return kNoVertex;
    far = third;
  }
  return far;
}

// Calls found(crossing, end, far vertex) for a and for b with each vertex that is seen from the corner c, which is
// opposite to the edge from a to b, if c is obtuse.
template <class Found>
void unfold(const WholeComplex& complex, const Incidence& triangles, std::uint32_t c, std::uint32_t a, std::uint32_t b,
            const Found& found) {
  constexpr int kMostTriangles = 32;
  const double ab = complex.length(a, b), ac = complex.length(a, c), bc = complex.length(b, c);
  if (!(ac * ac + bc * bc < ab * ab) || !(ac > 0) || !(bc > 0)) return;
  // c at the origin, a on the axis, b to the left of it.
  const PlanePoint to_a{ac, 0};
  const double b_x = (ac * ac + bc * bc - ab * ab) / (2 * ac);
  const PlanePoint to_b{b_x, std::sqrt(std::max(0.0, bc * bc - b_x * b_x))};
  PlaneVertex left{a, to_a}, right{b, to_b};
  PlanePoint first = to_a, last = to_b;  // what is seen through all edges lies between these
  std::uint32_t near = c;
  for (int i = 0; i < kMostTriangles; ++i) {
    const std::uint32_t far = far_vertex(complex, triangles, left.vertex, right.vertex, near);
    if (far == kNoVertex) return;
    const PlanePoint at =
        beyond(left.at, right.at, complex.length(far, left.vertex), complex.length(far, right.vertex));
    const bool before = cross(first, at) < 0, after = cross(at, last) < 0;
    const bool near_b = dot(to_a, at) <= 0, near_a = dot(to_b, at) <= 0;
    if (!before && !after) {
      found(Crossing{c, ac, length(at), length(at, to_a)}, a, far);
      found(Crossing{c, bc, length(at), length(at, to_b)}, b, far);
      if (!near_a && !near_b) return;
      (near_b ? last : first) = at;
    }
    // The next edge is the one through which the directions are seen that make acute angles with both sides.
    PlaneVertex& moved = before || (!after && !near_b) ? left : right;
    near = moved.vertex;
    moved = {far, at};
  }
}

}  // namespace

std::vector<double> geodesic_distance(const WholeComplex& complex, std::span<const std::uint32_t> sources,
                                      MemoryBudget& budget) {
  const std::uint32_t count = complex.vertex_count();
  // Distances, both incidences, and the queue, which rarely holds more than a few times the front.
  Reservation memory =
      budget.reserve("geodesic distance", std::uint64_t{30} * count + 20 * std::uint64_t{complex.triangles.size()} +
                                              8 * std::uint64_t{complex.edges.size()});
  const Incidence triangles = incidence_of(count, complex.triangles);
  const Incidence edges = incidence_of(count, complex.edges);
  const auto for_each_unfolded = [&](const auto& found) {
    for (const auto& t : complex.triangles)
      for (std::size_t i = 0; i < 3; ++i) unfold(complex, triangles, t[i], t[(i + 1) % 3], t[(i + 2) % 3], found);
  };
  // They are counted first, so that their memory is reserved before it is taken.
  std::size_t crossing_count = 0;
  for_each_unfolded([&](const Crossing&, std::uint32_t, std::uint32_t) { ++crossing_count; });
  require_numbers(crossing_count, "obtuse corners");
  memory.resize(memory.bytes() + 56 * crossing_count);
  Unfolded unfolded;
  unfolded.crossings.reserve(crossing_count);
  unfolded.ends.reserve(crossing_count);
  for_each_unfolded([&](const Crossing& crossing, std::uint32_t end, std::uint32_t far) {
    unfolded.crossings.push_back(crossing);
    unfolded.ends.push_back({end, far});
  });
  const Incidence crossings = incidence_of(count, unfolded.ends);
  std::vector<double> distance(count, kInfinite);
  std::vector<bool> final(count);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto improve = [&](std::uint32_t v, double value) {
    if (!(value < distance[v])) return;
    distance[v] = value;
    queue.emplace(value, v);
  };
  for (const std::uint32_t v : sources) improve(v, 0);
  while (!queue.empty()) {
    const auto [here, v] = queue.top();
    queue.pop();
    if (here > distance[v] || final[v]) continue;
    final[v] = true;
    for (const std::uint32_t e : edges.of(v)) {
      const auto& edge = complex.edges[e];
      const std::uint32_t other = edge[0] == v ? edge[1] : edge[0];
      improve(other, here + complex.length(v, other));
    }
    for (const std::uint32_t t : triangles.of(v)) {
      const auto& corners = complex.triangles[t];
      const std::size_t at = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
      const std::uint32_t p = corners[(at + 1) % 3], q = corners[(at + 2) % 3];
      const double vp = complex.length(v, p), vq = complex.length(v, q), pq = complex.length(p, q);
      improve(p, here + vp);
      improve(q, here + vq);
      if (final[q] && !final[p]) improve(p, across(here, distance[q], vq, vp, pq));
      if (final[p] && !final[q]) improve(q, across(here, distance[p], vp, vq, pq));
    }
    for (const std::uint32_t i : crossings.of(v)) {
      const Crossing& crossing = unfolded.crossings[i];
      const auto [first, second] = unfolded.ends[i];
      if (final[first] && final[second] && !final[crossing.corner])
        improve(crossing.corner,
                across(distance[first], distance[second], crossing.between, crossing.to_first, crossing.to_second));
    }
  }
  for (double& value : distance) value = std::ldexp(value, complex.unit_exponent);
  return distance;
}

}  // namespace reeb::io
