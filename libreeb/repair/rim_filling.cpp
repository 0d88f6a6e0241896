#include "libreeb/repair/rim_filling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/nearest_float32.h"

namespace reeb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Triangle = std::array<std::uint32_t, 3>;

bool joined(const Rim& rim, std::uint32_t a, std::uint32_t b) {
  return std::ranges::binary_search(rim.joined, std::pair(std::min(a, b), std::max(a, b)));
}

// The best triangulation of each part of the rim, from short parts to long ones.
class Triangulation {
 public:
  Triangulation(const Rim& rim, FillWeight weight)
      : rim_(rim), by_angle_(weight == FillWeight::kAngle), n_(static_cast<std::uint32_t>(rim.points.size())) {
    best_.resize(std::size_t{n_} * n_);
    for (std::uint32_t i = 0; i + 1 < n_; ++i) entry(i, i + 1) = {0, 0, i};
    for (std::uint32_t length = 2; length < n_; ++length)
      for (std::uint32_t i = 0; i + length < n_; ++i) choose(i, i + length);
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    if (!(entry(0, n_ - 1).area < kInfinity)) return result;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open = {{0, n_ - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j == i + 1) continue;
      const std::uint32_t k = entry(i, j).apex;
      result.push_back({i, k, j});
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
    return result;
  }

 private:
  struct Best {
    double angle = 0, area = kInfinity;
    std::uint32_t apex = 0;
  };
  Best& entry(std::uint32_t i, std::uint32_t j) { return best_[std::size_t{i} * n_ + j]; }
  const Best& entry(std::uint32_t i, std::uint32_t j) const { return best_[std::size_t{i} * n_ + j]; }

  void choose(std::uint32_t i, std::uint32_t j) {
    const bool is_whole = i == 0 && j == n_ - 1;
    if (!is_whole && joined(rim_, i, j)) return;
    Best best;
    const Point side = rim_.points[j] - rim_.points[i];
    for (std::uint32_t k = i + 1; k < j; ++k) {
      const Best &left = entry(i, k), &right = entry(k, j);
      double area = left.area + right.area;
      if (!(area < kInfinity) || (!by_angle_ && area >= best.area)) continue;
      const Point other = rim_.points[k] - rim_.points[i];
      const Point normal = cross(other, side);
      const double size = std::sqrt(dot(normal, normal));
      if (!(size > 1e-9 * std::max(dot(side, side), dot(other, other)))) continue;  // nearly without area
      area += size / 2;
      double angle = 0;
      if (by_angle_) {
        angle = std::max({left.angle, right.angle, bend(i, k, normal, size), bend(k, j, normal, size)});
        if (is_whole) angle = std::max(angle, bend_at(rim_.beside[j], j, i, normal, size));
        if (angle > best.angle || (angle == best.angle && area >= best.area))
          if (best.area < kInfinity) continue;
      } else if (area >= best.area) {
        continue;
      }
      best = {angle, area, k};
    }
    entry(i, j) = best;
  }

  // 1 minus the cosine of the angle between a triangle and its neighbour across the edge from a to b.
  double bend(std::uint32_t a, std::uint32_t b, const Point& normal, double size) const {
    if (b == a + 1) return bend_at(rim_.beside[a], a, b, normal, size);
    return bend_at(rim_.points[entry(a, b).apex], a, b, normal, size);
  }
  // The neighbour is (a, apex, b).
  double bend_at(const Point& apex, std::uint32_t a, std::uint32_t b, const Point& normal, double size) const {
    const Point other = cross(apex - rim_.points[a], rim_.points[b] - rim_.points[a]);
    const double length = std::sqrt(dot(other, other));
    return length > 0 ? 1 - dot(normal, other) / (size * length) : 2;
  }

  const Rim& rim_;
  const bool by_angle_;
  const std::uint32_t n_;
  std::vector<Best> best_;
};

// A filling that is refined: triangles are divided, edges turned, vertices moved.
class Refinement {
 public:
  Refinement(const Rim& rim, Filling& filling) : rim_(rim), filling_(filling), edge_(rim.edge) {
    for (std::uint32_t t = 0; t < filling_.triangles.size(); ++t) note(t);
  }

  void run(bool float32) {
    constexpr int kMostPasses = 16;
    turn_edges();
    for (int pass = 0; pass < kMostPasses && divide(); ++pass) turn_edges();
    fair();
    turn_edges();
    if (!float32) return;
    for (Filling::Vertex& vertex : filling_.vertices)
      for (double& x : vertex.position) x = nearest_float32(x);
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }
  std::uint32_t rim_size() const { return static_cast<std::uint32_t>(rim_.points.size()); }
  const Point& point(std::uint32_t v) const {
    return v < rim_size() ? rim_.points[v] : filling_.vertices[v - rim_size()].position;
  }

  using Sides = std::array<std::uint32_t, 2>;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  void note(std::uint32_t t) {
    const Triangle& c = filling_.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [it, fresh] = sides_.try_emplace(key(c[i], c[(i + 1) % 3]), Sides{t, kNone});
      if (!fresh) it->second[1] = t;
    }
  }
  void replace(std::uint32_t a, std::uint32_t b, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t& t : sides_.at(key(a, b)))
      if (t == from) t = to;
  }

  // Adds a vertex in each triangle that is large for the edges around it. Returns whether there was one.
  bool divide() {
    const std::size_t count = filling_.triangles.size();
    bool any = false;
    for (std::uint32_t t = 0; t < count; ++t) {
      const Triangle c = filling_.triangles[t];
      Point center{};
      double edge = 0;
      for (const std::uint32_t v : c) {
        edge += edge_[v] / 3;
        for (std::size_t k = 0; k < 3; ++k) center[k] += point(v)[k] / 3;
      }
      const bool large = std::ranges::all_of(
          c, [&](std::uint32_t v) { return std::sqrt(2.0) * distance(center, point(v)) > std::max(edge, edge_[v]); });
      if (!large) continue;
      any = true;
      const auto v = static_cast<std::uint32_t>(rim_size() + filling_.vertices.size());
      filling_.vertices.push_back({center, c});
      edge_.push_back(edge);
      const auto second = static_cast<std::uint32_t>(filling_.triangles.size()), third = second + 1;
      filling_.triangles[t] = {c[0], c[1], v};
      filling_.triangles.push_back({c[1], c[2], v});
      filling_.triangles.push_back({c[2], c[0], v});
      replace(c[1], c[2], t, second);
      replace(c[2], c[0], t, third);
      sides_[key(c[0], v)] = {t, third};
      sides_[key(c[1], v)] = {t, second};
      sides_[key(c[2], v)] = {second, third};
    }
    return any;
  }

  // The cotangent of the angle at `apex`.
  double cotangent(std::uint32_t apex, std::uint32_t a, std::uint32_t b) const {
    const Point u = point(a) - point(apex), w = point(b) - point(apex), n = cross(u, w);
    const double size = std::sqrt(dot(n, n));
    return size > 0 ? dot(u, w) / size : dot(u, w) < 0 ? -1e9 : 1e9;
  }

  // Turns the edges between two triangles whose opposite angles have a sum of more than 180 degrees.
  void turn_edges() {
    constexpr int kMostPasses = 12;
    std::vector<std::uint64_t> edges;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      edges.clear();
      for (const auto& [edge, sides] : sides_)
        if (sides[1] != kNone) edges.push_back(edge);
      std::sort(edges.begin(), edges.end());
      bool any = false;
      for (const std::uint64_t edge : edges)
        if (turn(static_cast<std::uint32_t>(edge >> 32), static_cast<std::uint32_t>(edge))) any = true;
      if (!any) return;
    }
  }

  bool turn(std::uint32_t a, std::uint32_t b) {
    const auto it = sides_.find(key(a, b));
    if (it == sides_.end() || it->second[1] == kNone) return false;
    std::uint32_t t = it->second[0], u = it->second[1];
    const auto runs = [&](const Triangle& c) {
      return (c[0] == a && c[1] == b) || (c[1] == a && c[2] == b) || (c[2] == a && c[0] == b);
    };
    if (!runs(filling_.triangles[t])) std::swap(t, u);
    const auto third = [&](const Triangle& c) { return c[0] ^ c[1] ^ c[2] ^ a ^ b; };
    const std::uint32_t c = third(filling_.triangles[t]), d = third(filling_.triangles[u]);
    if (cotangent(c, a, b) + cotangent(d, a, b) > -1e-6) return false;
    if (sides_.contains(key(c, d)) || (std::max(c, d) < rim_size() && joined(rim_, c, d))) return false;
    sides_.erase(it);
    filling_.triangles[t] = {a, d, c};
    filling_.triangles[u] = {d, b, c};
    sides_[key(c, d)] = {t, u};
    replace(b, c, t, u);
    replace(a, d, u, t);
    return true;
  }

  // Moves each new vertex to the mean of its neighbours: near a surface of least area.
  void fair() {
    constexpr int kMostSweeps = 400;
    std::vector<std::vector<std::uint32_t>> near(filling_.vertices.size());
    for (const auto& [edge, sides] : sides_) {
      const auto a = static_cast<std::uint32_t>(edge >> 32), b = static_cast<std::uint32_t>(edge);
      if (a >= rim_size()) near[a - rim_size()].push_back(b);
      if (b >= rim_size()) near[b - rim_size()].push_back(a);
    }
    for (auto& list : near) std::sort(list.begin(), list.end());  // the order of a hash table means nothing
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double most = 0;
      for (std::size_t i = 0; i < near.size(); ++i) {
        Point mean{};
        for (const std::uint32_t v : near[i])
          for (std::size_t k = 0; k < 3; ++k) mean[k] += point(v)[k] / static_cast<double>(near[i].size());
        Point& position = filling_.vertices[i].position;
        most = std::max(most, distance(mean, position) / edge_[rim_size() + i]);
        position = mean;
      }
      if (most < 1e-3) return;
    }
  }

  const Rim& rim_;
  Filling& filling_;
  std::vector<double> edge_;
  std::unordered_map<std::uint64_t, Sides> sides_;
};

}  // namespace

std::optional<Filling> fill_rim(const Rim& rim, const FillOptions& options) {
  Filling filling;
  filling.triangles = Triangulation(rim, options.weight).triangles();
  if (filling.triangles.empty()) return std::nullopt;
  if (options.refine) Refinement(rim, filling).run(options.float32);
  return filling;
}

}  // namespace reeb
