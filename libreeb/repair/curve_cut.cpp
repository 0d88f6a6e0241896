#include "libreeb/repair/curve_cut.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "libreeb/base/vector3.h"
#include "libreeb/containers/flat_map.h"
#include "libreeb/repair/rim_filling.h"
#include "libreeb/repair/tight_curve.h"
#include "libreeb/repair/triangle_crossing.h"
#include "libreeb/repair/triangle_split.h"

namespace reeb {
namespace {

constexpr std::uint32_t kNone = EditablePatch::kNone;
constexpr std::size_t kWideRim = 10;  // in edges: a filling of a wider one is refined and faired
constexpr int kMostGrowth = 2;        // rings that a band is widened by

using Vertices = std::vector<std::uint32_t>;

void make_set(Vertices& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

// Sets of triangles or vertices, by number.
class Marks {
 public:
  bool has(std::uint32_t x) const { return place_.find(x) != FlatMap::kNone; }
  bool add(std::uint32_t x) {
    const auto place = static_cast<std::uint32_t>(list_.size());
    if (place_.find_or_insert(x, place) != place) return false;
    list_.push_back(x);
    return true;
  }
  const Vertices& list() const { return list_; }

 private:
  FlatMap place_;
  Vertices list_;
};

// The triangles that touch the curve on either side; nothing if it does not have two sides.
std::optional<std::array<Vertices, 2>> sides_of(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  std::array<Vertices, 2> sides;
  Vertices first;
  patch.for_each_at_edge(curve[0], curve[1], [&](std::uint32_t t) { first.push_back(t); });
  if (first.size() != 2) return std::nullopt;
  const std::size_t n = curve.size();
  for (std::size_t side = 0; side < 2; ++side) {
    std::uint32_t t = first[side];
    for (std::size_t i = 1; i <= n; ++i) {
      // Around this vertex from the edge before it to the edge after it.
      const std::uint32_t x = curve[i % n], next = curve[(i + 1) % n];
      std::uint32_t at = curve[i - 1];
      for (std::size_t steps = patch.all_at(x).size() + 1;; --steps) {
        if (steps == 0) return std::nullopt;
        sides[side].push_back(t);
        at = patch.third_corner(t, x, at);
        if (at == next) break;
        t = patch.across(t, x, at);
        if (t == kNone) return std::nullopt;
      }
    }
    if (t != first[side]) return std::nullopt;
    make_set(sides[side]);
  }
  return sides;
}

// The closed boundary of a set of triangles, apart from the curve: in order, or nothing if it is not one simple path
// away from the curve.
class Band {
 public:
  Band(const EditablePatch& patch, std::span<const std::uint32_t> curve, const Vertices& side, const Vertices& other)
      : patch_(patch), curve_(curve) {
    for (const std::uint32_t v : curve) on_curve_.add(v);
    for (const std::uint32_t t : other) forbidden_.add(t);
    for (const std::uint32_t t : side) ok_ = ok_ && !forbidden_.has(t) && inside_.add(t);
  }

  // Adds the triangles around it.
  void grow() {
    const Vertices before = inside_.list();
    for (const std::uint32_t t : before)
      for (const std::uint32_t v : patch_.triangle(t).corners)
        if (!on_curve_.has(v)) add_around(v);
  }

  // Adds what is pinched or enclosed, until the rim is one simple path. Returns it; empty if that fails.
  Vertices close_rim() {
    constexpr int kMostRounds = 12;
    for (int round = 0; ok_ && round < kMostRounds; ++round) {
      find_edges();
      bool pinched = false;
      for (std::size_t i = 0; i < edges_.size(); ++i) {
        const std::uint32_t v = edges_[i].first;
        if (on_curve_.has(v)) return {};
        // Each vertex is at two edges, each of which is listed in both directions.
        if ((i == 0 || edges_[i - 1].first != v) && i + 2 < edges_.size() && edges_[i + 2].first == v) {
          add_around(v);
          pinched = true;
        }
      }
      if (pinched) continue;
      std::vector<Vertices> rims = paths();
      if (rims.empty()) return {};
      if (rims.size() == 1) return rims[0].size() >= 3 ? rims[0] : Vertices{};
      if (!enclose(rims)) return {};
    }
    return {};
  }

  const Vertices& triangles() const { return inside_.list(); }

 private:
  void add(std::uint32_t t) {
    if (forbidden_.has(t))
      ok_ = false;
    else
      inside_.add(t);
  }
  void add_around(std::uint32_t v) {
    ok_ = ok_ && patch_.vertex(v).whole;
    patch_.for_each_at(v, [&](std::uint32_t t) { add(t); });
  }

  bool is_on_curve(std::uint32_t a, std::uint32_t b) const {
    if (!on_curve_.has(a) || !on_curve_.has(b)) return false;
    for (std::size_t i = 0; i < curve_.size(); ++i) {
      const std::uint32_t c = curve_[i], d = curve_[(i + 1) % curve_.size()];
      if ((a == c && b == d) || (a == d && b == c)) return true;
    }
    return false;
  }

  void find_edges() {
    edges_.clear();
    for (const std::uint32_t t : inside_.list()) {
      const auto& c = patch_.triangle(t).corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = c[i], b = c[(i + 1) % 3], other = patch_.across(t, a, b);
        if (other == kNone) {
          ok_ = false;
          return;
        }
        if (inside_.has(other) || is_on_curve(a, b)) continue;
        edges_.emplace_back(a, b);
        edges_.emplace_back(b, a);
      }
    }
    std::sort(edges_.begin(), edges_.end());
  }

  // REQUIRES: each vertex is at two edges.
  std::vector<Vertices> paths() const {
    std::vector<Vertices> result;
    std::vector<std::uint8_t> seen(edges_.size(), 0);
    for (std::size_t first = 0; first < edges_.size(); first += 2) {
      if (seen[first] != 0) continue;
      Vertices path;
      std::size_t at = first;  // of the two entries of a vertex the first one
      std::uint32_t before = kNone;
      while (seen[at] == 0) {
        seen[at] = 1;
        const std::uint32_t v = edges_[at].first;
        path.push_back(v);
        if (at + 1 >= edges_.size() || edges_[at + 1].first != v) return {};
        const std::uint32_t next = edges_[at].second != before ? edges_[at].second : edges_[at + 1].second;
        before = v;
        const auto it = std::lower_bound(edges_.begin(), edges_.end(), std::pair(next, std::uint32_t{0}));
        at = static_cast<std::size_t>(it - edges_.begin());
      }
      result.push_back(std::move(path));
    }
    return result;
  }

  // Adds the parts of the surface beyond all rims but one if they are small. Returns whether there was one.
  bool enclose(const std::vector<Vertices>& rims) {
    constexpr std::size_t kMostEnclosed = 200;
    bool any = false;
    for (const Vertices& rim : rims) {
      Marks part;
      patch_.for_each_at_edge(rim[0], rim[1], [&](std::uint32_t t) {
        if (!inside_.has(t)) part.add(t);
      });
      bool open = false;
      for (std::size_t i = 0; i < part.list().size() && !open; ++i) {
        const std::uint32_t t = part.list()[i];
        open = part.list().size() > kMostEnclosed || forbidden_.has(t);
        const auto& c = patch_.triangle(t).corners;
        for (std::size_t k = 0; k < 3 && !open; ++k) {
          const std::uint32_t other = patch_.across(t, c[k], c[(k + 1) % 3]);
          if (other == kNone)
            open = true;
          else if (!inside_.has(other))
            part.add(other);
        }
      }
      if (open) continue;
      any = true;
      for (const std::uint32_t t : part.list()) add(t);
    }
    return any;
  }

  const EditablePatch& patch_;
  const std::span<const std::uint32_t> curve_;
  Marks on_curve_, inside_, forbidden_;
  bool ok_ = true;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

Vertices corners_of(const EditablePatch& patch, const Vertices& triangles) {
  Vertices result;
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : patch.triangle(t).corners) result.push_back(v);
  make_set(result);
  return result;
}

// The vertices less the edges plus the triangles that have no other vertices than these.
std::int64_t euler_among(const EditablePatch& patch, const Vertices& sorted) {
  const auto in = [&](std::uint32_t v) { return std::ranges::binary_search(sorted, v); };
  std::int64_t vertices = 0, triangles = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const std::uint32_t v : sorted) {
    vertices += patch.is_used(v) ? 1 : 0;
    patch.for_each_at(v, [&](std::uint32_t t) {
      const auto& c = patch.triangle(t).corners;
      for (const std::uint32_t w : c)
        if (w > v && in(w)) edges.emplace_back(v, w);
      if (std::ranges::min(c) == v && in(c[0]) && in(c[1]) && in(c[2])) ++triangles;
    });
  }
  std::sort(edges.begin(), edges.end());
  const auto distinct = std::unique(edges.begin(), edges.end()) - edges.begin();
  return vertices - distinct + triangles;
}

// What one attempt does to the patch, to be undone if it is no good.
class Edit {
 public:
  // `split`: what was done to the patch for this attempt before; it is not undone.
  Edit(EditablePatch& patch, const CutOptions& options, const PatchSplit* split = nullptr)
      : patch_(patch),
        options_(options),
        split_(split),
        vertices_(patch.vertex_count()),
        triangles_(patch.triangle_count()) {}

  void remove(const Vertices& triangles) {
    for (const std::uint32_t t : triangles) {
      patch_.remove(t);
      removed_.push_back(t);
    }
  }

  void undo() {
    patch_.take_back(vertices_, triangles_);
    for (const std::uint32_t t : removed_) patch_.restore(t);
  }

  // Fills a path of edges with one triangle each. False if there is no such filling.
  bool fill(Vertices path, FillWeight weight, bool refine) {
    if (path.size() < 3 || path.size() > kMostRimVertices) return false;
    // New triangles run against their neighbours.
    std::size_t along = 0;
    const std::size_t n = path.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t t = only_at(path[i], path[(i + 1) % n]);
      if (t == kNone) return false;
      along += patch_.runs_along(t, path[i], path[(i + 1) % n]) ? 1u : 0u;
    }
    if (2 * along > n) std::reverse(path.begin(), path.end());
    Rim rim;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t v = path[i], next = path[(i + 1) % n];
      rim.points.push_back(patch_.position(v));
      rim.beside.push_back(patch_.position(patch_.third_corner(only_at(v, next), v, next)));
      double sum = 0;
      std::size_t count = 0;
      patch_.for_each_at(v, [&](std::uint32_t t) {
        for (const std::uint32_t w : patch_.triangle(t).corners)
          if (w != v) {
            sum += distance(patch_.position(v), patch_.position(w));
            ++count;
            if (const auto it = std::find(path.begin(), path.end(), w); it != path.end())
              if (const auto k = static_cast<std::size_t>(it - path.begin()); k > i)
                rim.joined.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
          }
      });
      rim.edge.push_back(sum / static_cast<double>(count));
    }
    std::sort(rim.joined.begin(), rim.joined.end());
    const auto filling = fill_rim(rim, {weight, refine && n > kWideRim, options_.float32});
    if (!filling) return false;
    const auto base = static_cast<std::uint32_t>(patch_.vertex_count());
    const auto number = [&](std::uint32_t v) { return v < n ? path[v] : base + (v - static_cast<std::uint32_t>(n)); };
    for (const Filling::Vertex& vertex : filling->vertices) {
      EditablePatch::Vertex added{VertexId::none(), vertex.position, true, false, {}};
      for (std::size_t k = 0; k < 3; ++k) added.parents[k] = number(vertex.parents[k]);
      patch_.add_vertex(added);
    }
    for (const auto& c : filling->triangles) patch_.add_new({number(c[0]), number(c[1]), number(c[2])});
    return true;
  }

  // Of divided triangles, those count that were there before, and the parts that are there now.
  void count(Cut& cut) const {
    const std::size_t first = first_new();
    cut.removed = split_ != nullptr ? split_->removed.size() : 0;
    for (const std::uint32_t t : removed_) cut.removed += t < first ? 1u : 0u;
    cut.added = 0;
    for (auto t = static_cast<std::uint32_t>(first); t < patch_.triangle_count(); ++t)
      cut.added += patch_.triangle(t).there ? 1u : 0u;
  }

  // All vertices of triangles that were removed or added.
  Vertices touched() const {
    Vertices result;
    const auto take = [&](std::uint32_t t) {
      for (const std::uint32_t v : patch_.triangle(t).corners) result.push_back(v);
    };
    for (const std::uint32_t t : removed_) take(t);
    if (split_ != nullptr)
      for (const std::uint32_t t : split_->removed) take(t);
    for (auto t = static_cast<std::uint32_t>(first_new()); t < patch_.triangle_count(); ++t) take(t);
    make_set(result);
    return result;
  }

  // Of removed triangles, or of added ones: six times the volume under them, seen from one of their corners.
  double volume() const {
    const Vertices all = touched();
    const Point origin = patch_.position(all[0]);
    double sum = 0;
    const auto under = [&](std::uint32_t t) {
      const auto& c = patch_.triangle(t).corners;
      const Point a = patch_.position(c[0]) - origin, b = patch_.position(c[1]) - origin,
                  d = patch_.position(c[2]) - origin;
      return a[0] * (b[1] * d[2] - b[2] * d[1]) + a[1] * (b[2] * d[0] - b[0] * d[2]) +
             a[2] * (b[0] * d[1] - b[1] * d[0]);
    };
    for (const std::uint32_t t : removed_) sum -= under(t);
    for (auto t = static_cast<std::uint32_t>(triangles_); t < patch_.triangle_count(); ++t) sum += under(t);
    return sum / 6;
  }

  // Whether a new triangle lies nearly on its neighbour.
  bool folds() const {
    constexpr double kMostCosine = -0.98;
    for (auto t = static_cast<std::uint32_t>(triangles_); t < patch_.triangle_count(); ++t) {
      const auto& c = patch_.triangle(t).corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t other = patch_.across(t, c[i], c[(i + 1) % 3]);
        if (other == kNone) continue;
        const Point n = normal(t), m = normal(other);
        if (dot(n, m) < kMostCosine * std::sqrt(dot(n, n) * dot(m, m))) return true;
      }
    }
    return false;
  }

  bool crosses() const {
    const auto first = static_cast<std::uint32_t>(first_new()),
               end = static_cast<std::uint32_t>(patch_.triangle_count());
    if (first == end) return false;
    PointBox all = PointBox::around(patch_.placed(end - 1).points);
    std::vector<PointBox> boxes;
    for (std::uint32_t t = first; t < end; ++t) {
      const PlacedTriangle placed = patch_.placed(t);
      boxes.push_back(PointBox::around(placed.points));
      if (!patch_.triangle(t).there) continue;
      if (is_flat(placed)) return true;
      all.add(boxes.back());
    }
    // With new triangles from number `from` on.
    const auto crosses_new = [&](const PlacedTriangle& triangle, const PointBox& box, std::uint32_t from) {
      for (std::uint32_t t = from; t < end; ++t)
        if (patch_.triangle(t).there && box.meets(boxes[t - first]) && triangles_cross(triangle, patch_.placed(t)))
          return true;
      return false;
    };
    for (const PlacedTriangle& obstacle : patch_.obstacles())
      if (const PointBox box = PointBox::around(obstacle.points); box.meets(all) && crosses_new(obstacle, box, first))
        return true;
    bool found = false;
    patch_.cells().visit(all, [&](std::uint32_t u) {
      if (!patch_.triangle(u).there) return true;
      const PlacedTriangle placed = patch_.placed(u);
      const PointBox box = PointBox::around(placed.points);
      found = box.meets(all) && crosses_new(placed, box, std::max(first, u + 1));
      return !found;
    });
    return found;
  }

 private:
  // The parts of divided triangles are new, too.
  std::size_t first_new() const { return split_ != nullptr ? split_->triangles : triangles_; }

  Point normal(std::uint32_t t) const {
    const auto& c = patch_.triangle(t).corners;
    const Point& apex = patch_.position(c[0]);
    return cross(patch_.position(c[1]) - apex, patch_.position(c[2]) - apex);
  }

  // The triangle at an edge that has no other.
  std::uint32_t only_at(std::uint32_t a, std::uint32_t b) const {
    std::uint32_t only = kNone;
    std::size_t count = 0;
    patch_.for_each_at_edge(a, b, [&](std::uint32_t t) {
      ++count;
      only = t;
    });
    return count == 1 ? only : kNone;
  }

  EditablePatch& patch_;
  const CutOptions& options_;
  const PatchSplit* split_;
  std::size_t vertices_, triangles_;  // before
  Vertices removed_;
};

// Whether a way along triangles leads from one rim to the other.
bool are_connected(const EditablePatch& patch, const Vertices& from, const Vertices& to) {
  Marks goal, reached;
  for (const std::uint32_t v : to) goal.add(v);
  reached.add(from[0]);
  for (std::size_t i = 0; i < reached.list().size(); ++i) {
    bool found = false;
    patch.for_each_at(reached.list()[i], [&](std::uint32_t t) {
      for (const std::uint32_t v : patch.triangle(t).corners) {
        reached.add(v);
        found = found || goal.has(v);
      }
    });
    if (found) return true;
  }
  return false;
}

bool is_manifold(const EditablePatch& patch, const Edit& edit, const Vertices& touched, std::int64_t euler) {
  for (const std::uint32_t v : touched)
    if (patch.is_used(v) && !patch.is_closed_fan(v)) return false;
  return euler_among(patch, edit.touched()) == euler;
}

constexpr const char* kRepeats = "every filling would repeat an edge of the surface";
constexpr const char* kNoManifold = "the filling would not be a manifold";
constexpr const char* kCrosses = "every filling would cross the surface";

struct Attempt {
  int growth;
  std::size_t side;
  FillWeight weight;
  bool refine;
};

std::vector<Attempt> attempts_for(std::size_t size) {
  std::vector<Attempt> attempts;
  for (int growth = 0; growth <= kMostGrowth; ++growth)
    for (const bool refine : {true, false})
      for (const FillWeight weight : {FillWeight::kArea, FillWeight::kAngle})
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
          if (refine || size > kWideRim - 4) attempts.push_back({growth, side, weight, refine});
  return attempts;
}

Cut not_done(std::string why) {
  Cut cut;
  cut.why = std::move(why);
  return cut;
}

// Whether the curve could be much shorter: it has some edges, and every second vertex is much nearer than along them.
bool is_crooked(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  constexpr std::size_t kSomeEdges = 8;
  constexpr double kMostStraight = 0.9;  // a circle of eight edges has 0.92
  if (curve.size() < kSomeEdges) return false;
  double edges = 0, chords = 0;
  const std::size_t n = curve.size();
  for (std::size_t i = 0; i < n; ++i) {
    edges += distance(patch.position(curve[i]), patch.position(curve[(i + 1) % n]));
    chords += distance(patch.position(curve[i]), patch.position(curve[(i + 2) % n])) / 2;
  }
  return chords < kMostStraight * edges;
}

bool is_on_surface(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (!patch.has_edge(curve[i], curve[(i + 1) % curve.size()])) return false;
  return curve.size() >= 3;
}

// `split`: what was done for this.
Cut try_cut(EditablePatch& patch, std::span<const std::uint32_t> curve, const CutOptions& options,
            const PatchSplit* split) {
  if (!is_on_surface(patch, curve)) return not_done("an earlier repair changed the surface at its curve");
  if (curve.size() > kMostRimVertices)
    return not_done("its curve has more than " + std::to_string(kMostRimVertices) + " edges");
  const auto sides = sides_of(patch, curve);
  if (!sides) {
    Cut cut = not_done("the surface is not an oriented manifold at its curve");
    cut.too_small = !std::ranges::all_of(curve, [&](std::uint32_t v) { return patch.vertex(v).whole; });
    return cut;
  }
  std::string why = "there is no room for a band beside its curve";
  bool too_small = false;
  std::optional<Attempt> folded;  // the first attempt whose only fault is that it folds
  const auto succeeds = [&](const Attempt& attempt, bool may_fold, Cut& cut) {
    Band band(patch, curve, (*sides)[attempt.side], (*sides)[1 - attempt.side]);
    for (int ring = 0; ring < attempt.growth; ++ring) band.grow();
    cut.first_side.assign(curve.begin(), curve.end());
    cut.second_side = band.close_rim();
    if (cut.second_side.empty()) return false;
    Edit edit(patch, options, split);
    Vertices before = edit.touched();
    for (const std::uint32_t v : corners_of(patch, band.triangles())) before.push_back(v);
    make_set(before);
    if (!std::ranges::all_of(before, [&](std::uint32_t v) { return patch.vertex(v).whole; })) {
      too_small = true;
      return false;
    }
    const std::int64_t euler = euler_among(patch, before);
    edit.remove(band.triangles());
    const auto fails = [&](const char* fault) {
      why = fault;
      edit.undo();
      return false;
    };
    if (!edit.fill(cut.first_side, attempt.weight, attempt.refine) ||
        !edit.fill(cut.second_side, attempt.weight, attempt.refine))
      return fails(kRepeats);
    if (!is_manifold(patch, edit, before, euler + 2)) return fails(kNoManifold);
    const bool folds = !may_fold && edit.folds();
    if ((folds && folded) || edit.crosses()) return fails(kCrosses);
    if (folds) {
      folded = attempt;
      return fails(kCrosses);
    }
    cut.done = true;
    edit.count(cut);
    cut.volume = edit.volume();
    cut.connected = are_connected(patch, cut.first_side, cut.second_side);
    return true;
  };
  for (const Attempt& attempt : attempts_for(curve.size()))
    if (Cut cut; succeeds(attempt, false, cut)) return cut;
  if (folded)
    if (Cut cut; succeeds(*folded, true, cut)) return cut;
  Cut cut = not_done(why);
  cut.too_small = too_small;
  return cut;
}

}  // namespace

Cut cut_along(EditablePatch& patch, std::span<const std::uint32_t> curve, const CutOptions& options) {
  constexpr double kMuchShorter = 0.85;
  const bool whole = std::ranges::all_of(curve, [&](std::uint32_t v) { return patch.vertex(v).whole; });
  const bool can_divide = whole && is_on_surface(patch, curve) && sides_of(patch, curve);
  const auto cut_tight = [&](double most) {
    const auto tight = pull_tight(patch, curve, most, options.float32);
    if (!tight) return Cut{};
    Cut cut = try_cut(patch, tight->curve, options, &tight->split);
    if (!cut.done) undo_split(patch, tight->split);
    return cut;
  };
  if (can_divide && is_crooked(patch, curve))
    if (Cut cut = cut_tight(kMuchShorter); cut.done) return cut;
  Cut plain = try_cut(patch, curve, options, nullptr);
  if (plain.done || plain.too_small || !can_divide) return plain;
  const PatchSplit split = make_room(patch, {curve.begin(), curve.end()}, options.float32);
  Cut roomy = try_cut(patch, curve, options, &split);
  if (roomy.done) return roomy;
  undo_split(patch, split);
  plain.too_small = roomy.too_small;
  if (Cut cut = cut_tight(1); cut.done) return cut;
  return plain;
}

Cut close_boundary(EditablePatch& patch, std::span<const std::uint32_t> rim, const CutOptions& options) {
  const Vertices path(rim.begin(), rim.end());
  if (path.size() > kMostRimVertices)
    return not_done("it has more than " + std::to_string(kMostRimVertices) + " edges");
  if (!std::ranges::all_of(path, [&](std::uint32_t v) { return patch.vertex(v).whole; })) {
    Cut cut = not_done("the triangles around it are too large");
    cut.too_small = true;
    return cut;
  }
  std::string why = kRepeats;
  for (const bool refine : {true, false})
    for (const FillWeight weight : {FillWeight::kArea, FillWeight::kAngle}) {
      if (!refine && path.size() <= kWideRim) continue;
      Edit edit(patch, options);
      Vertices touched = path;
      make_set(touched);
      const std::int64_t euler = euler_among(patch, touched);
      if (edit.fill(path, weight, refine)) {
        if (!is_manifold(patch, edit, touched, euler + 1)) {
          why = kNoManifold;
        } else if (edit.crosses()) {
          why = kCrosses;
        } else {
          Cut cut;
          cut.done = cut.connected = true;
          edit.count(cut);
          cut.volume = edit.volume();
          return cut;
        }
      }
      edit.undo();
    }
  return not_done(why);
}

}  // namespace reeb
