#include "tests/model/reference_census.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace reeb::test {
namespace {

using Vector = std::array<double, 3>;

VertexSet as_set(std::vector<std::uint64_t> vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// The classes of things that are related, each by its least member.
template <class Thing>
class Classes {
 public:
  void add(const Thing& thing) { above_.emplace(thing, thing); }
  Thing least(const Thing& thing) const {
    Thing at = thing;
    while (above_.at(at) != at) at = above_.at(at);
    return at;
  }
  void join(const Thing& a, const Thing& b) {
    const Thing x = least(a), y = least(b);
    if (x != y) above_[std::max(x, y)] = std::min(x, y);
    above_[a] = above_[b] = std::min(x, y);
  }
  std::size_t count() const {
    return static_cast<std::size_t>(
        std::count_if(above_.begin(), above_.end(), [](const auto& entry) { return entry.first == entry.second; }));
  }

 private:
  std::map<Thing, Thing> above_;
};

Vector normal(const Vector& a, const Vector& b, const Vector& c) {
  Vector p, q;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = b[k] - a[k];
    q[k] = c[k] - a[k];
  }
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

double product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

class Census {
 public:
  explicit Census(const Complex& complex) : complex_(complex) {
    for (const auto& simplex : complex.simplices) list(simplex);
    for (const auto& [triangle, copies] : triangles_)
      for (std::size_t k = 0; k < 3; ++k) {
        VertexSet edge = triangle;
        edge.erase(edge.begin() + static_cast<std::ptrdiff_t>(k));
        edges_[edge].push_back(triangle);
      }
  }

  ReferenceCensus take() {
    count_components();
    count_boundaries();
    for (const auto& [edge, around] : edges_) {
      if (around.empty()) result_.loose_edges.insert(edge);
      if (around.size() > 2) result_.nonmanifold_edges.insert(edge);
      if (around.size() == 2 && is_folded(edge, around[0], around[1])) result_.folded.insert(edge);
    }
    for (std::uint64_t v = 0; v < complex_.vertex_count(); ++v)
      if (!is_manifold(v)) result_.nonmanifold_vertices.insert({v});
    for (const auto& [triangle, copies] : triangles_)
      if (copies.size() > 1) result_.duplicates[triangle] = copies.size() - 1;
    result_.euler = static_cast<std::int64_t>(complex_.vertex_count()) - static_cast<std::int64_t>(edges_.size()) +
                    static_cast<std::int64_t>(triangles_.size());
    result_.closed = !triangles_.empty() && result_.boundaries.empty() && result_.loose_edges.empty();
    if (result_.nonmanifold_edges.empty()) {
      result_.orientable = is_orientable();
      result_.oriented = is_oriented();
    }
    if (!triangles_.empty() && result_.nonmanifold_edges.empty() && result_.nonmanifold_vertices.empty() &&
        result_.loose_edges.empty() && *result_.orientable)
      result_.genus = genus();
    return std::move(result_);
  }

 private:
  void list(const std::vector<std::uint64_t>& simplex) {
    const VertexSet corners = as_set(simplex);
    if (corners.size() == 2) edges_.emplace(corners, std::vector<VertexSet>{});
    if (simplex.size() == 3 && corners.size() < 3) ++result_.degenerate[corners];
    if (corners.size() == 3) triangles_[corners].push_back(simplex);
  }

  void count_components() {
    Classes<std::uint64_t> classes;
    for (std::uint64_t v = 0; v < complex_.vertex_count(); ++v) classes.add(v);
    for (const auto& [edge, around] : edges_) classes.join(edge[0], edge[1]);
    std::map<std::uint64_t, ReferenceComponent> components;
    for (std::uint64_t v = 0; v < complex_.vertex_count(); ++v) {
      component_of_.push_back(classes.least(v));
      auto& component = components[classes.least(v)];
      component.lowest = classes.least(v);
      ++component.vertices;
    }
    for (const auto& [triangle, copies] : triangles_) components[classes.least(triangle[0])].triangles += copies.size();
    for (const auto& [lowest, component] : components) result_.components.push_back(component);
  }

  void count_boundaries() {
    Classes<std::uint64_t> classes;
    for (const auto& [edge, around] : edges_)
      if (around.size() == 1)
        for (const std::uint64_t v : edge) classes.add(v);
    for (const auto& [edge, around] : edges_)
      if (around.size() == 1) classes.join(edge[0], edge[1]);
    std::map<std::uint64_t, ReferenceBoundary> boundaries;
    for (const auto& [edge, around] : edges_) {
      if (around.size() != 1) continue;
      const Vector &a = complex_.positions[edge[0]], &b = complex_.positions[edge[1]];
      ReferenceBoundary& boundary = boundaries[classes.least(edge[0])];
      if (boundary.edges == 0) boundary = {0, classes.least(edge[0]), 0, a, a};
      ++boundary.edges;
      boundary.length += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        boundary.min[k] = std::min({boundary.min[k], a[k], b[k]});
        boundary.max[k] = std::max({boundary.max[k], a[k], b[k]});
      }
    }
    for (const auto& [lowest, boundary] : boundaries) result_.boundaries.push_back(boundary);
  }

  std::uint64_t opposite(const VertexSet& triangle, const VertexSet& edge) const {
    return *std::find_if(triangle.begin(), triangle.end(),
                         [&](std::uint64_t v) { return v != edge[0] && v != edge[1]; });
  }

  // Whether the normals of two triangles that agree at the edge are more than 170 degrees apart.
  bool is_folded(const VertexSet& edge, const VertexSet& one, const VertexSet& other) const {
    const auto at = [&](std::uint64_t v) { return complex_.positions[v]; };
    const Vector a = normal(at(edge[0]), at(edge[1]), at(opposite(one, edge)));
    const Vector b = normal(at(edge[1]), at(edge[0]), at(opposite(other, edge)));
    const double lengths = std::sqrt(product(a, a)) * std::sqrt(product(b, b));
    if (lengths == 0) return false;
    const double cosine = std::clamp(product(a, b) / lengths, -1.0, 1.0);
    return std::acos(cosine) * 180 / std::numbers::pi > 170;
  }

  // Whether the link of a vertex of a triangle is one path or one cycle.
  bool is_manifold(std::uint64_t v) const {
    if (links_.empty()) list_links();
    const auto& [nodes, pairs] = links_[v];
    if (pairs.empty()) return true;
    Classes<std::uint64_t> parts;
    std::map<std::uint64_t, int> degree;
    for (const std::uint64_t node : nodes) parts.add(node);
    for (const auto& [a, b] : pairs) {
      parts.join(a, b);
      ++degree[a];
      ++degree[b];
    }
    return parts.count() == 1 &&
           std::all_of(degree.begin(), degree.end(), [](const auto& entry) { return entry.second <= 2; });
  }

  void list_links() const {
    links_.resize(complex_.vertex_count());
    for (const auto& [edge, around] : edges_) {
      links_[edge[0]].first.push_back(edge[1]);
      links_[edge[1]].first.push_back(edge[0]);
    }
    for (const auto& [triangle, copies] : triangles_)
      for (std::size_t k = 0; k < 3; ++k)
        links_[triangle[k]].second.emplace_back(triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
  }

  // Whether the triangle passes the edge from its lower end to its higher one.
  static bool passes_upward(const std::vector<std::uint64_t>& corners, const VertexSet& edge) {
    const auto lo = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), edge[0]) - corners.begin());
    return corners[(lo + 1) % 3] == edge[1];
  }

  // The same of a triangle as a whole: whether its corners are in the order of its sorted corners, or of a rotation.
  static bool is_even(const std::vector<std::uint64_t>& corners, const VertexSet& triangle) {
    const auto first = std::find(corners.begin(), corners.end(), triangle[0]) - corners.begin();
    return corners[(static_cast<std::size_t>(first) + 1) % 3] == triangle[1];
  }

  bool is_oriented() const {
    for (const auto& [triangle, copies] : triangles_)
      for (const auto& copy : copies)
        if (is_even(copy, triangle) != is_even(copies[0], triangle)) return false;
    for (const auto& [edge, around] : edges_) {
      if (around.size() != 2) continue;
      const bool first = passes_upward(triangles_.at(around[0])[0], edge);
      for (const auto& copy : triangles_.at(around[0]))
        if (passes_upward(copy, edge) != first) return false;
      for (const auto& copy : triangles_.at(around[1]))
        if (passes_upward(copy, edge) == first) return false;
    }
    return true;
  }

  // Turns triangles, one after the other, as a neighbour wants it.
  bool is_orientable() const {
    std::map<VertexSet, bool> turned;
    for (const auto& [start, copies] : triangles_) {
      if (!turned.emplace(start, false).second) continue;
      std::vector<VertexSet> waiting{start};
      while (!waiting.empty()) {
        const VertexSet triangle = waiting.back();
        waiting.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
          VertexSet edge = triangle;
          edge.erase(edge.begin() + static_cast<std::ptrdiff_t>(k));
          for (const VertexSet& other : edges_.at(edge)) {
            if (other == triangle) continue;
            const bool upward = passes_upward(triangle, edge) != turned.at(triangle);
            const bool turn = passes_upward(other, edge) == upward;
            const auto [at, is_new] = turned.emplace(other, turn);
            if (is_new) waiting.push_back(other);
            if (at->second != turn) return false;
          }
        }
      }
    }
    return true;
  }

  // Component by component.
  std::uint64_t genus() const {
    std::map<std::uint64_t, std::int64_t> euler, holes;
    std::set<std::uint64_t> surfaces;
    for (std::uint64_t v = 0; v < complex_.vertex_count(); ++v) ++euler[component_of_[v]];
    for (const auto& [edge, around] : edges_) --euler[component_of_[edge[0]]];
    for (const auto& [triangle, copies] : triangles_) {
      ++euler[component_of_[triangle[0]]];
      surfaces.insert(component_of_[triangle[0]]);
    }
    for (const ReferenceBoundary& boundary : result_.boundaries) ++holes[component_of_[boundary.lowest]];
    std::uint64_t sum = 0;
    for (const std::uint64_t surface : surfaces)
      sum += static_cast<std::uint64_t>((2 - euler[surface] - holes[surface]) / 2);
    return sum;
  }

  const Complex& complex_;
  std::map<VertexSet, std::vector<std::vector<std::uint64_t>>> triangles_;  // distinct ones, and all copies as listed
  std::map<VertexSet, std::vector<VertexSet>> edges_;                       // and the distinct triangles at each
  std::vector<std::uint64_t> component_of_;
  mutable std::vector<std::pair<std::vector<std::uint64_t>, std::vector<std::pair<std::uint64_t, std::uint64_t>>>>
      links_;
  ReferenceCensus result_;
};

}  // namespace

ReferenceCensus reference_census(const Complex& complex) { return Census(complex).take(); }

}  // namespace reeb::test
