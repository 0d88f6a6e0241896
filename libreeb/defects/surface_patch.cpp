#include "libreeb/defects/surface_patch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {
namespace {

// Whether the triangle runs along the edge from a to b.
bool runs_along(const std::array<std::uint32_t, 3>& t, std::uint32_t a, std::uint32_t b) {
  for (std::size_t i = 0; i < 3; ++i)
    if (t[i] == a && t[(i + 1) % 3] == b) return true;
  return false;
}

}  // namespace

double distance(const Point& a, const Point& b) {
  const Point d = a - b;
  return std::sqrt(dot(d, d));
}

SurfacePatch::SurfacePatch(PatchContent content) : content_(std::move(content)) {
  make_edges();
  orient();
}

std::uint32_t SurfacePatch::find(VertexId vertex) const {
  const auto it = std::lower_bound(content_.vertices.begin(), content_.vertices.end(), vertex);
  return it == content_.vertices.end() || *it != vertex ? kNone
                                                        : static_cast<std::uint32_t>(it - content_.vertices.begin());
}

void SurfacePatch::make_edges() {
  struct Side {
    std::uint64_t ends;
    std::uint32_t triangle, number;
  };
  std::vector<Side> sides;
  sides.reserve(3 * content_.triangles.size());
  for (std::uint32_t t = 0; t < triangle_count(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(content_.triangles[t][i], content_.triangles[t][(i + 1) % 3]);
      sides.push_back({std::uint64_t{a} << 32 | b, t, i});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& l, const Side& r) { return std::pair(l.ends, l.triangle) < std::pair(r.ends, r.triangle); });
  triangle_edges_.resize(content_.triangles.size());
  edge_triangles_.reserve(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].ends != sides[i - 1].ends) {
      const auto a = static_cast<std::uint32_t>(sides[i].ends >> 32), b = static_cast<std::uint32_t>(sides[i].ends);
      edge_first_.push_back(static_cast<std::uint32_t>(i));
      edges_.push_back({a, b, distance(position(a), position(b))});
    }
    triangle_edges_[sides[i].triangle][sides[i].number] = edge_count() - 1;
    edge_triangles_.push_back(sides[i].triangle);
  }
  edge_first_.push_back(static_cast<std::uint32_t>(sides.size()));

  vertex_first_.assign(content_.vertices.size() + 1, 0);
  for (const Edge& edge : edges_) {
    ++vertex_first_[edge.a + 1];
    ++vertex_first_[edge.b + 1];
  }
  for (std::size_t v = 0; v < content_.vertices.size(); ++v) vertex_first_[v + 1] += vertex_first_[v];
  vertex_edges_.resize(2 * edges_.size());
  std::vector<std::uint32_t> next(vertex_first_.begin(), vertex_first_.end() - 1);
  for (std::uint32_t e = 0; e < edge_count(); ++e) {
    vertex_edges_[next[edges_[e].a]++] = e;
    vertex_edges_[next[edges_[e].b]++] = e;
  }
}

void SurfacePatch::orient() {
  turned_.assign(content_.triangles.size(), 0);
  std::vector<std::uint8_t> seen(content_.triangles.size(), 0);
  std::vector<std::uint32_t> part;
  for (std::uint32_t first = 0; first < triangle_count(); ++first) {
    if (seen[first] != 0) continue;
    part.assign(1, first);
    seen[first] = 1;
    std::size_t turned_count = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t t = part[i];
      turned_count += turned_[t];
      for (const std::uint32_t e : triangle_edges_[t]) {
        const auto at = triangles_at_edge(e);
        if (at.size() != 2) continue;
        const std::uint32_t other = at[0] == t ? at[1] : at[0];
        if (seen[other] != 0) continue;
        seen[other] = 1;
        const auto [a, b] = std::pair(edges_[e].a, edges_[e].b);
        const bool alike = runs_along(content_.triangles[t], a, b) != runs_along(content_.triangles[other], a, b);
        turned_[other] = static_cast<std::uint8_t>(turned_[t] ^ (alike ? 0 : 1));
        part.push_back(other);
      }
    }
    if (2 * turned_count > part.size())
      for (const std::uint32_t t : part) turned_[t] ^= 1;
  }
}

std::array<std::uint32_t, 3> SurfacePatch::oriented(std::uint32_t t) const {
  auto corners = content_.triangles[t];
  if (turned(t)) std::swap(corners[1], corners[2]);
  return corners;
}

bool SurfacePatch::consistent(std::uint32_t e) const {
  const auto at = triangles_at_edge(e);
  return at.size() == 2 &&
         runs_along(oriented(at[0]), edges_[e].a, edges_[e].b) != runs_along(oriented(at[1]), edges_[e].a, edges_[e].b);
}

std::uint32_t SurfacePatch::edge_between(std::uint32_t a, std::uint32_t b) const {
  for (const std::uint32_t e : edges_at(a))
    if (edges_[e].a == b || edges_[e].b == b) return e;
  return kNone;
}

Point SurfacePatch::normal(std::uint32_t t) const {
  const auto [a, b, c] = oriented(t);
  const Point u = position(b) - position(a), w = position(c) - position(a);
  return {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
}

}  // namespace reeb
