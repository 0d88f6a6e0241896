#include "libreeb/defects/surface_patch.h"

#include <algorithm>
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
    std::uint32_t b, triangle, number;
    bool operator<(const Side& other) const { return b != other.b ? b < other.b : triangle < other.triangle; }
  };
  // By the lower end; then those of each vertex by the upper one.
  std::vector<std::uint32_t> first(content_.vertices.size() + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < triangle_count(); ++t)
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(content_.triangles[t][i], content_.triangles[t][(i + 1) % 3]);
        visit(a, Side{b, t, i});
      }
  };
  for_each_side([&](std::uint32_t a, const Side&) { ++first[a + 1]; });
  for (std::size_t v = 0; v < content_.vertices.size(); ++v) first[v + 1] += first[v];
  std::vector<Side> sides(3 * content_.triangles.size());
  std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
  for_each_side([&](std::uint32_t a, const Side& side) { sides[end[a]++] = side; });
  triangle_edges_.resize(content_.triangles.size());
  edge_triangles_.reserve(sides.size());
  for (std::uint32_t a = 0; a < content_.vertices.size(); ++a) {
    std::sort(sides.begin() + first[a], sides.begin() + first[a + 1]);
    for (std::size_t i = first[a]; i < first[a + 1]; ++i) {
      const auto& [b, triangle, number] = sides[i];
      if (i == first[a] || b != sides[i - 1].b) {
        edge_first_.push_back(static_cast<std::uint32_t>(i));
        edges_.push_back({a, b, distance(position(a), position(b))});
      }
      triangle_edges_[triangle][number] = edge_count() - 1;
      edge_triangles_.push_back(triangle);
    }
  }
  edge_first_.push_back(static_cast<std::uint32_t>(sides.size()));

  vertex_first_.assign(content_.vertices.size() + 1, 0);
  for (const Edge& edge : edges_) {
    ++vertex_first_[edge.a + 1];
    ++vertex_first_[edge.b + 1];
  }
  for (std::size_t v = 0; v < content_.vertices.size(); ++v) vertex_first_[v + 1] += vertex_first_[v];
  vertex_edges_.resize(2 * edges_.size());
  end.assign(vertex_first_.begin(), vertex_first_.end() - 1);
  for (std::uint32_t e = 0; e < edge_count(); ++e) {
    vertex_edges_[end[edges_[e].a]++] = e;
    vertex_edges_[end[edges_[e].b]++] = e;
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
  return cross(position(b) - position(a), position(c) - position(a));
}

}  // namespace reeb
