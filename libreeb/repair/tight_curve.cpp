#include "libreeb/repair/tight_curve.h"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "libreeb/base/vector3.h"

namespace reeb {
namespace {

using Vertices = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the smaller number first

constexpr std::uint32_t kNowhere = EditablePatch::kNone;
constexpr int kCoarse = 6, kFine = 2;  // twelfths of an edge between two places on it

// The triangles around a closed curve, if they are a band with two rims. Its places are the corners of the triangles,
// and some on each edge.
class RingBand {
 public:
  RingBand(const EditablePatch& patch, std::span<const std::uint32_t> curve, int rings, int step)
      : patch_(patch), step_(step), places_on_edge_(static_cast<std::uint32_t>(12 / step - 1)) {
    std::map<std::uint32_t, std::uint8_t> in;
    Vertices open(curve.begin(), curve.end());
    for (int ring = 0; ring < rings; ++ring) {
      Vertices next;
      for (const std::uint32_t v : open)
        patch.for_each_at(v, [&](std::uint32_t t) {
          if (!in.emplace(t, 1).second) return;
          triangles_.push_back(t);
          for (const std::uint32_t w : patch.triangle(t).corners) next.push_back(w);
        });
      open = std::move(next);
    }
    std::sort(triangles_.begin(), triangles_.end());
    number();
  }

  // With two rims, and a way from one to the other.
  bool is_closed_band() { return is_manifold() && find_way(); }

  struct Place {
    std::uint32_t a = kNowhere, b = kNowhere;  // on this edge, or the vertex a
    int twelfths = 0;
    Point point{};
  };
  const Place& place(std::uint32_t p) const { return places_[p]; }
  // Where every closed curve around the band passes.
  const Vertices& way() const { return way_; }
  std::uint32_t place_of(std::uint32_t v) const { return vertex_place_.at(v); }
  std::uint32_t places_on_edge() const { return places_on_edge_; }
  std::uint32_t place_on(std::uint32_t a, std::uint32_t b, std::uint32_t k) const {
    return edge_place_.at(std::minmax(a, b)) + k;
  }

  // The shortest closed curve around the band through one place, and its length; none if it is not shorter than `most`.
  Vertices loop_through(std::uint32_t from, double& most) const {
    const auto count = static_cast<std::uint32_t>(places_.size());
    std::vector<double> length(2 * count, kFar);
    Vertices before(2 * count, kNowhere);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    length[from] = 0;
    queue.emplace(0, from);
    const std::uint32_t goal = from + count;
    while (!queue.empty() && queue.top().first < length[goal]) {
      const auto [so_far, state] = queue.top();
      queue.pop();
      if (so_far > length[state]) continue;
      const std::uint32_t p = state % count;
      const int round = state < count ? 0 : 1;
      for (const std::uint32_t t : at_[p])
        for (const std::uint32_t q : of_[t]) {
          if (q == p) continue;
          // Who leaves the way to its left is one time more around.
          const int left = side_[t] == Side::kLeft ? 1 : 0;
          const int next_round = round + left * ((on_way_[p] != 0 ? 1 : 0) - (on_way_[q] != 0 ? 1 : 0));
          if (next_round < 0 || next_round > 1) continue;
          const double next = so_far + distance(places_[p].point, places_[q].point);
          const std::uint32_t to = q + (next_round == 1 ? count : 0);
          if (!(next < most) || next >= length[to]) continue;
          length[to] = next;
          before[to] = state;
          queue.emplace(next, to);
        }
    }
    if (!(length[goal] < most)) return {};
    most = length[goal];
    Vertices loop;
    for (std::uint32_t state = before[goal]; state != kNowhere; state = before[state]) loop.push_back(state % count);
    return loop;
  }

  // A triangle of the band with both places.
  std::uint32_t triangle_with(std::uint32_t p, std::uint32_t q) const {
    for (const std::uint32_t t : at_[p])
      if (std::ranges::find(of_[t], q) != of_[t].end()) return triangles_[t];
    return kNowhere;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  enum class Side : std::uint8_t { kNeither, kLeft, kRight };

  void number() {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const auto& c = patch_.triangle(triangles_[i]).corners;
      Vertices of;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [vertex, fresh] = vertex_place_.try_emplace(c[k], static_cast<std::uint32_t>(places_.size()));
        if (fresh) places_.push_back({c[k], kNowhere, 0, patch_.position(c[k])});
        of.push_back(vertex->second);
        const Edge edge = std::minmax(c[k], c[(k + 1) % 3]);
        const auto [first, fresh_edge] = edge_place_.try_emplace(edge, static_cast<std::uint32_t>(places_.size()));
        for (std::uint32_t place = 0; place < places_on_edge_; ++place) {
          if (fresh_edge) places_.push_back(place_at(edge, static_cast<int>(place + 1) * step_));
          of.push_back(first->second + place);
        }
        sides_[edge].push_back(i);
      }
      of_.push_back(std::move(of));
    }
    at_.resize(places_.size());
    for (std::uint32_t i = 0; i < of_.size(); ++i)
      for (const std::uint32_t p : of_[i]) at_[p].push_back(i);
  }

  Place place_at(const Edge& edge, int twelfths) const {
    Place place{edge.first, edge.second, twelfths, patch_.position(edge.first)};
    const Point& end = patch_.position(edge.second);
    for (std::size_t k = 0; k < 3; ++k) place.point[k] += (end[k] - place.point[k]) * (twelfths / 12.0);
    return place;
  }

  // Whether it is an oriented manifold with Euler characteristic 0 and two simple rims, and may be divided.
  bool is_manifold() {
    for (const auto& [v, place] : vertex_place_)
      if (!patch_.vertex(v).whole || !patch_.is_closed_fan(v)) return false;
    std::map<std::uint32_t, Vertices> rim;
    for (const auto& [edge, sides] : sides_) {
      if (sides.size() > 2) return false;
      if (sides.size() == 2) {
        if (patch_.runs_along(triangles_[sides[0]], edge.first, edge.second) ==
            patch_.runs_along(triangles_[sides[1]], edge.first, edge.second))
          return false;
        continue;
      }
      rim[edge.first].push_back(edge.second);
      rim[edge.second].push_back(edge.first);
    }
    if (vertex_place_.size() + triangles_.size() != sides_.size()) return false;
    std::uint8_t rims = 0;
    for (const auto& [start, next] : rim) {
      if (next.size() != 2) return false;
      if (rim_of_.contains(start)) continue;
      ++rims;
      Vertices open = {start};
      while (!open.empty()) {
        const std::uint32_t v = open.back();
        open.pop_back();
        if (!rim_of_.emplace(v, rims).second) continue;
        for (const std::uint32_t w : rim[v]) open.push_back(w);
      }
    }
    return rims == 2;
  }

  // The shortest way along edges from one rim to the other, and the triangles on either side of it.
  bool find_way() {
    std::map<std::uint32_t, std::uint32_t> before;
    Vertices open;
    for (const auto& [v, rim] : rim_of_)
      if (rim == 1) {
        before.emplace(v, kNowhere);
        open.push_back(v);
      }
    std::uint32_t end = kNowhere;
    for (std::size_t i = 0; i < open.size() && end == kNowhere; ++i)
      for (const std::uint32_t t : at_[place_of(open[i])])
        for (const std::uint32_t w : patch_.triangle(triangles_[t]).corners) {
          if (!before.emplace(w, open[i]).second) continue;
          open.push_back(w);
          if (const auto it = rim_of_.find(w); end == kNowhere && it != rim_of_.end()) end = w;
        }
    for (; end != kNowhere; end = before[end]) way_.push_back(end);
    on_way_.assign(places_.size(), 0);
    side_.assign(triangles_.size(), Side::kNeither);
    for (const std::uint32_t v : way_) on_way_[place_of(v)] = 1;
    for (std::size_t i = 0; i + 1 < way_.size(); ++i) {
      const Edge edge = std::minmax(way_[i], way_[i + 1]);
      for (std::uint32_t k = 0; k < places_on_edge_; ++k) on_way_[edge_place_.at(edge) + k] = 1;
      for (const std::uint32_t t : sides_.at(edge))
        if (!put(t, patch_.runs_along(triangles_[t], way_[i], way_[i + 1]) ? Side::kLeft : Side::kRight)) return false;
    }
    // Around each vertex of the way, from triangle to triangle.
    for (const std::uint32_t v : way_)
      for (bool again = true; again;) {
        again = false;
        for (const std::uint32_t t : at_[place_of(v)])
          for (const std::uint32_t w : patch_.triangle(triangles_[t]).corners) {
            const Edge edge = std::minmax(v, w);
            if (w == v || side_[t] == Side::kNeither || on_way_[edge_place_.at(edge)] != 0) continue;
            for (const std::uint32_t u : sides_.at(edge)) {
              again = again || side_[u] == Side::kNeither;
              if (!put(u, side_[t])) return false;
            }
          }
      }
    return way_.size() >= 2;
  }

  bool put(std::uint32_t t, Side side) {
    if (side_[t] == Side::kNeither) side_[t] = side;
    return side_[t] == side;
  }

  const EditablePatch& patch_;
  const int step_;
  const std::uint32_t places_on_edge_;
  Vertices triangles_;
  std::vector<Place> places_;
  std::map<std::uint32_t, std::uint32_t> vertex_place_;
  std::map<Edge, std::uint32_t> edge_place_;  // the first one
  std::map<Edge, Vertices> sides_;
  std::vector<Vertices> of_;  // the places of each triangle
  std::vector<Vertices> at_;  // the triangles at each place
  std::map<std::uint32_t, std::uint8_t> rim_of_;
  Vertices way_;
  std::vector<std::uint8_t> on_way_;
  std::vector<Side> side_;
};

// The place where the way across the band crosses the curve.
std::uint32_t crossing_of(const RingBand& band, std::span<const std::uint32_t> curve) {
  const auto it = std::ranges::find_if(band.way(), [&](std::uint32_t v) { return std::ranges::count(curve, v) != 0; });
  return it == band.way().end() ? kNowhere : band.place_of(*it);
}

// The shortest closed curve through a place on the way across the band; none if it is not shorter than `most`.
Vertices shortest_loop(const RingBand& band, double& most) {
  const Vertices& way = band.way();
  Vertices best;
  std::size_t best_vertex = 0;
  for (std::size_t i = 0; i < way.size(); ++i)
    if (Vertices loop = band.loop_through(band.place_of(way[i]), most); !loop.empty()) {
      best = std::move(loop);
      best_vertex = i;
    }
  for (std::size_t i = best_vertex == 0 ? 0 : best_vertex - 1; i < std::min(best_vertex + 1, way.size() - 1); ++i)
    for (std::uint32_t k = 0; k < band.places_on_edge(); ++k)
      if (Vertices loop = band.loop_through(band.place_on(way[i], way[i + 1], k), most); !loop.empty())
        best = std::move(loop);
  return best;
}

}  // namespace

std::optional<TightCurve> pull_tight(EditablePatch& patch, std::span<const std::uint32_t> curve, double most,
                                     bool float32) {
  constexpr int kMostRings = 3;
  constexpr double kPromising = 1.06;  // how much longer the first loop may be
  double length = 0;
  for (std::size_t i = 0; i < curve.size(); ++i)
    length += distance(patch.position(curve[i]), patch.position(curve[(i + 1) % curve.size()]));
  for (int rings = kMostRings; rings > 0; --rings) {
    RingBand coarse(patch, curve, rings, kCoarse);
    if (!coarse.is_closed_band()) continue;
    const std::uint32_t crossing = crossing_of(coarse, curve);
    double first = kPromising * most * length;
    if (crossing == kNowhere || coarse.loop_through(crossing, first).empty()) return std::nullopt;
    RingBand band(patch, curve, rings, kFine);
    if (!band.is_closed_band()) return std::nullopt;
    TightCurve tight;
    tight.length = most * length;
    const Vertices loop = shortest_loop(band, tight.length);
    if (loop.size() < 3) return std::nullopt;
    TriangleSplit split(patch, float32);
    for (const std::uint32_t p : loop) {
      const RingBand::Place& place = band.place(p);
      tight.curve.push_back(place.twelfths == 0 ? place.a : split.point_on(place.a, place.b, place.twelfths));
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::size_t j = (i + 1) % loop.size();
      split.join(band.triangle_with(loop[i], loop[j]), tight.curve[i], tight.curve[j]);
    }
    tight.split = split.run();
    Vertices sorted = tight.curve;
    std::sort(sorted.begin(), sorted.end());
    bool ok = std::unique(sorted.begin(), sorted.end()) == sorted.end();
    for (std::size_t i = 0; i < loop.size(); ++i)
      ok = ok && patch.has_edge(tight.curve[i], tight.curve[(i + 1) % loop.size()]);
    if (ok) return tight;
    undo_split(patch, tight.split);
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace reeb
