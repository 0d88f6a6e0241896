#include "libreeb/defects/curve_length.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace reeb {
namespace {

// A closed curve through triangles: the edges that it crosses, in order, and where.
struct Crossing {
  std::uint32_t edge = 0;
  double place = 0;  // along the edge, from its end a
};
using Sleeve = std::vector<Crossing>;

constexpr int kSweeps = 100, kTurns = 16;
constexpr double kLeastMove = 1e-3;  // of a crossing, as a share of its edge

class Tightening {
 public:
  Tightening(const SurfacePatch& patch, const ClosedPath& path) : patch_(patch) {
    const auto& x = path.vertices;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::uint32_t before = patch.edge_between(x[i], x[(i + x.size() - 1) % x.size()]),
                          after = patch.edge_between(x[i], x[(i + 1) % x.size()]);
      // Counterclockwise from the edge after x to the edge before it; the curve passes them the other way round.
      std::vector<std::uint32_t> fan = fan_of(patch, x[i]);
      std::rotate(fan.begin(), std::ranges::find(fan, after), fan.end());
      fan.erase(std::ranges::find(fan, before), fan.end());
      for (std::size_t k = fan.size(); k-- > 1;) push(sleeve_, {fan[k], place_of(fan[k], x[i])});
    }
    close(sleeve_);
  }

  double run(double longest) {
    double best = longest;
    for (int turn = 0; turn < kTurns && !sleeve_.empty(); ++turn) {
      for (int sweep = 0; sweep < kSweeps && relax() > kLeastMove; ++sweep) continue;
      const double now = length();
      if (turn > 0 && now > best * (1 - 1e-4)) return std::min(best, now);
      best = std::min(best, now);
      if (!turn_corners()) break;
    }
    return best;
  }

 private:
  // Near the vertex, not at it: crossings that coincide hold each other.
  double place_of(std::uint32_t e, std::uint32_t vertex) const {
    return patch_.edge(e).length * (patch_.edge(e).a == vertex ? 0.2 : 0.8);
  }

  Point point(const Crossing& crossing) const {
    const auto& edge = patch_.edge(crossing.edge);
    const double part = edge.length > 0 ? crossing.place / edge.length : 0;
    Point p{};
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = patch_.position(edge.a)[k] * (1 - part) + patch_.position(edge.b)[k] * part;
    return p;
  }

  // To cross an edge and return at once is not to cross it.
  static void push(Sleeve& sleeve, const Crossing& crossing) {
    if (!sleeve.empty() && sleeve.back().edge == crossing.edge)
      sleeve.pop_back();
    else
      sleeve.push_back(crossing);
  }
  static void close(Sleeve& sleeve) {
    while (sleeve.size() > 1 && sleeve.front().edge == sleeve.back().edge) {
      sleeve.pop_back();
      sleeve.erase(sleeve.begin());
    }
  }

  double length() const {
    double sum = 0;
    for (std::size_t i = 0; i < sleeve_.size(); ++i)
      sum += distance(point(sleeve_[i]), point(sleeve_[(i + 1) % sleeve_.size()]));
    return sum;
  }

  // Moves each crossing to where the way between its neighbours is shortest: where a straight line crosses the edge
  // when both triangles are laid flat.
  // Returns how far one moved at most.
  double relax() {
    double most = 0;
    const std::size_t n = sleeve_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto& edge = patch_.edge(sleeve_[i].edge);
      if (edge.length == 0) continue;
      const Point from = patch_.position(edge.a), along = patch_.position(edge.b) - from;
      double place[2], height[2];
      for (std::size_t side = 0; side < 2; ++side) {
        const Point d = point(sleeve_[side == 0 ? (i + n - 1) % n : (i + 1) % n]) - from;
        place[side] = dot(d, along) / edge.length;
        height[side] = std::sqrt(std::max(0.0, dot(d, d) - place[side] * place[side]));
      }
      const double sum = height[0] + height[1];
      const double best = sum > 0 ? (place[0] * height[1] + place[1] * height[0]) / sum : (place[0] + place[1]) / 2;
      const double now = std::clamp(best, 0.0, edge.length);
      most = std::max(most, std::abs(now - sleeve_[i].place) / edge.length);
      sleeve_[i].place = now;
    }
    return most;
  }

  // The vertex at which the curve crosses this edge; kNone if it is between both.
  std::uint32_t corner(const Crossing& crossing) const {
    const auto& edge = patch_.edge(crossing.edge);
    if (crossing.place < 0.02 * edge.length) return edge.a;
    return crossing.place > 0.98 * edge.length ? edge.b : SurfacePatch::kNone;
  }

  // Where the curve is held by a vertex, it passes on the other side of it from now on. Returns whether there is one.
  bool turn_corners() {
    const std::size_t n = sleeve_.size();
    std::size_t start = 0;
    while (start < n && corner(sleeve_[start]) == corner(sleeve_[(start + n - 1) % n]) &&
           corner(sleeve_[start]) != SurfacePatch::kNone)
      ++start;
    if (start == n) return false;
    std::rotate(sleeve_.begin(), sleeve_.begin() + static_cast<std::ptrdiff_t>(start), sleeve_.end());
    Sleeve turned;
    bool any = false;
    for (std::size_t i = 0; i < n;) {
      const std::uint32_t x = corner(sleeve_[i]);
      std::size_t end = i + 1;
      while (x != SurfacePatch::kNone && end < n && corner(sleeve_[end]) == x) ++end;
      if (x == SurfacePatch::kNone || !turn_corner(x, i, end, turned))
        for (std::size_t k = i; k < end; ++k) push(turned, sleeve_[k]);
      else
        any = true;
      i = end;
    }
    close(turned);
    sleeve_ = std::move(turned);
    return any;
  }

  // Passes x on the other side than crossings i to end - 1 do.
  bool turn_corner(std::uint32_t x, std::size_t i, std::size_t end, Sleeve& turned) const {
    std::vector<std::uint32_t> fan = fan_of(patch_, x);
    const auto first = std::ranges::find(fan, sleeve_[i].edge);
    if (first == fan.end() || end - i >= fan.size()) return false;
    std::rotate(fan.begin(), first, fan.end());
    // Which way round: into the triangle after the first edge, or the one before it.
    const std::uint32_t before = sleeve_[(i + sleeve_.size() - 1) % sleeve_.size()].edge;
    bool clockwise = false;
    if (end - i > 1) {
      clockwise = fan[1] != sleeve_[i + 1].edge;
    } else {
      for (const std::uint32_t t : patch_.triangles_at_edge(before))
        if (const auto& edges = patch_.edges_of(t); std::ranges::find(edges, fan[0]) != edges.end())
          clockwise = std::ranges::find(edges, fan[1]) != edges.end();
    }
    if (clockwise) std::reverse(fan.begin() + 1, fan.end());
    for (std::size_t k = fan.size(); k-- > end - i;) push(turned, {fan[k], place_of(fan[k], x)});
    return true;
  }

  const SurfacePatch& patch_;
  Sleeve sleeve_;
};

}  // namespace

double tight_length(const SurfacePatch& patch, const ClosedPath& path) {
  return Tightening(patch, path).run(path.length);
}

}  // namespace reeb
