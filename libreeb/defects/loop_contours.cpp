#include "libreeb/defects/loop_contours.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "libreeb/base/sweep_key.h"
#include "libreeb/containers/union_find.h"

namespace reeb {
namespace {

constexpr std::uint32_t kNone = SurfacePatch::kNone;

// Places in the total order: vertex of rank r is at 2 r, and the level just above it at 2 r + 1.
using Place = std::uint32_t;

struct Heights {
  std::vector<Place> of_vertex;
  std::vector<std::uint32_t> by_rank;
};

Heights heights(const SurfacePatch& patch, std::span<const double> values) {
  Heights h;
  h.by_rank.resize(patch.vertex_count());
  std::iota(h.by_rank.begin(), h.by_rank.end(), 0u);
  std::sort(h.by_rank.begin(), h.by_rank.end(), [&](std::uint32_t a, std::uint32_t b) {
    return SweepKey{values[a], patch.vertex(a)} < SweepKey{values[b], patch.vertex(b)};
  });
  h.of_vertex.resize(patch.vertex_count());
  for (std::uint32_t r = 0; r < patch.vertex_count(); ++r) h.of_vertex[h.by_rank[r]] = 2 * r;
  return h;
}

// About 24 levels between two vertices: evenly by rank, and closer and closer to both ends, where arcs are short.
std::vector<Place> choose_levels(Place v, Place y) {
  const Place first = v + 1, last = y - 1;
  std::vector<Place> levels;
  if (last - first <= 48) {
    for (Place level = first; level <= last; level += 2) levels.push_back(level);
    return levels;
  }
  for (Place step = 0; step < (last - first) / 4; step = 2 * step + 2) {
    levels.push_back(first + step);
    levels.push_back(last - step);
  }
  for (Place i = 1; i < 12; ++i) levels.push_back((first + (last - first) / 12 * i) | 1);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

// The components of what is strictly between two places: of edges, named by one of them.
class Slice {
 public:
  explicit Slice(std::uint32_t edges) : parent_(edges, kNone) {}

  void clear() {
    for (const std::uint32_t e : used_) parent_[e] = kNone;
    used_.clear();
  }
  void add(std::uint32_t e) {
    if (parent_[e] != kNone) return;
    parent_[e] = e;
    used_.push_back(e);
  }
  void unite(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }
  std::uint32_t find(std::uint32_t e) {
    while (parent_[e] != e) e = parent_[e] = parent_[parent_[e]];
    return e;
  }
  const std::vector<std::uint32_t>& used() const { return used_; }

 private:
  std::vector<std::uint32_t> parent_, used_;
};

struct Contour {
  std::uint32_t level = 0, edge = 0;   // one of the edges that it crosses
  std::uint32_t below = 0, above = 0;  // parts of slabs
  double length = 0;
  ContourEnd end = ContourEnd::kCloses;
};

// The interlevel set cut at the levels: its parts between two levels, joined by contours.
class Slabs {
 public:
  Slabs(const SurfacePatch& patch, std::span<const double> values, std::uint32_t v, std::uint32_t y)
      : patch_(patch), values_(values), heights_(heights(patch, values)), v_(v), y_(y), slice_(patch.edge_count()) {
    levels_ = choose_levels(heights_.of_vertex[v], heights_.of_vertex[y]);
    make_parts();
    make_contours();
  }

  struct Part {
    bool at_v = false, at_y = false, at_rim = false;
  };

  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<Contour>& contours() const { return contours_; }

  std::size_t level_count() const { return levels_.size(); }

  // What is of part `side` at a level, as one curve; the parts by side, where 0 is an unknown one.
  LoopContour sides_at(std::size_t level, std::span<const std::uint8_t> side_of_part, std::uint8_t side) const {
    LoopContour result;
    result.crossings.assign(patch_.edge_count(), 0);
    result.end = ContourEnd::kRim;
    for (const auto& [e, part] : part_below_[level]) {
      if (side_of_part[part] == 0) result.crossings[e] = kBarred;
      if (side_of_part[part] != side) continue;
      result.crossings[e] = 1;
      result.gates.push_back(lower_end(e));
    }
    sort_unique(result.gates);
    return result;
  }

  LoopContour trace(const Contour& contour) {
    LoopContour result{Crossings(patch_.edge_count(), 0), {}, contour.length, contour.end, 0, {}};
    join_level(contour.level);
    const std::uint32_t root = slice_.find(contour.edge);
    std::vector<Point> points;
    for (const std::uint32_t e : slice_.used()) {
      if (slice_.find(e) != root) continue;
      result.crossings[e] = 1;
      result.gates.push_back(lower_end(e));
      points.push_back(point_at(contour.level, e));
    }
    result.place = curve_place(points);
    for (const std::uint32_t t : triangles_at(contour.level))
      for (const std::uint32_t e : patch_.edges_of(t))
        if (result.crossings[e] != 0) {
          ++result.triangles;
          break;
        }
    sort_unique(result.gates);
    return result;
  }

  // How many edges at a level are in parts of each side.
  std::array<std::size_t, 3> count_at(std::size_t level, std::span<const std::uint8_t> side_of_part) const {
    std::array<std::size_t, 3> count{};
    for (const auto& [e, part] : part_below_[level]) ++count[side_of_part[part]];
    return count;
  }

 private:
  static void sort_unique(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  }
  std::uint32_t lower_end(std::uint32_t e) const {
    const auto& edge = patch_.edge(e);
    return heights_.of_vertex[edge.a] < heights_.of_vertex[edge.b] ? edge.a : edge.b;
  }
  std::pair<Place, Place> span_of(std::uint32_t e) const {
    return std::minmax(heights_.of_vertex[patch_.edge(e).a], heights_.of_vertex[patch_.edge(e).b]);
  }
  Place bottom(std::size_t slab) const { return slab == 0 ? heights_.of_vertex[v_] : levels_[slab - 1]; }
  Place top(std::size_t slab) const { return slab == levels_.size() ? heights_.of_vertex[y_] : levels_[slab]; }
  // From the first slab whose top is above the lowest corner to the last whose bottom is below the highest.
  std::span<const std::uint32_t> triangles_of(std::size_t slab) const {
    return std::span(slab_triangles_).subspan(slab_first_[slab], slab_first_[slab + 1] - slab_first_[slab]);
  }
  std::span<const std::uint32_t> triangles_at(std::size_t level) const { return triangles_of(level); }

  void sort_triangles() {
    const std::size_t slabs = levels_.size() + 1;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> range(patch_.triangle_count());
    slab_first_.assign(slabs + 1, 0);
    for (std::uint32_t t = 0; t < patch_.triangle_count(); ++t) {
      const auto [a, b, c] = patch_.triangle(t);
      const auto [low, high] = std::minmax({heights_.of_vertex[a], heights_.of_vertex[b], heights_.of_vertex[c]});
      auto& [first, end] = range[t];
      if (high <= bottom(0) || low >= top(levels_.size())) continue;
      first = static_cast<std::uint32_t>(std::upper_bound(levels_.begin(), levels_.end(), low) - levels_.begin());
      end = static_cast<std::uint32_t>(std::lower_bound(levels_.begin(), levels_.end(), high) - levels_.begin()) + 1;
      for (std::uint32_t slab = first; slab < end; ++slab) ++slab_first_[slab + 1];
    }
    for (std::size_t slab = 0; slab < slabs; ++slab) slab_first_[slab + 1] += slab_first_[slab];
    slab_triangles_.resize(slab_first_.back());
    std::vector<std::uint32_t> next(slab_first_.begin(), slab_first_.end() - 1);
    for (std::uint32_t t = 0; t < patch_.triangle_count(); ++t)
      for (std::uint32_t slab = range[t].first; slab < range[t].second; ++slab) slab_triangles_[next[slab]++] = t;
  }

  void join_slab(std::size_t slab) {
    slice_.clear();
    const Place low = bottom(slab), high = top(slab);
    const auto inside = [&](std::uint32_t e) {
      const auto [a, b] = span_of(e);
      return a < high && b > low;
    };
    for (const std::uint32_t t : triangles_of(slab)) {
      std::uint32_t first = kNone;
      for (const std::uint32_t e : patch_.edges_of(t)) {
        if (!inside(e)) continue;
        slice_.add(e);
        if (first == kNone) first = e;
        slice_.unite(first, e);
      }
    }
    // Triangles that share a vertex only are connected there.
    for (const std::uint32_t t : triangles_of(slab))
      for (const std::uint32_t x : patch_.triangle(t)) {
        const Place place = heights_.of_vertex[x];
        if (place <= low || place >= high || vertex_seen_[x] == slab) continue;
        vertex_seen_[x] = static_cast<std::uint32_t>(slab);
        const auto edges = patch_.edges_at(x);
        for (const std::uint32_t e : edges) {
          slice_.add(e);
          slice_.add(edges[0]);
          slice_.unite(edges[0], e);
        }
      }
  }

  void join_level(std::size_t level) {
    slice_.clear();
    for (const std::uint32_t t : triangles_at(level)) {
      std::uint32_t first = kNone;
      for (const std::uint32_t e : patch_.edges_of(t)) {
        if (!crosses(e, level)) continue;
        slice_.add(e);
        if (first == kNone) first = e;
        slice_.unite(first, e);
      }
    }
  }

  bool crosses(std::uint32_t e, std::size_t level) const {
    const auto [a, b] = span_of(e);
    return a < levels_[level] && b > levels_[level];
  }

  void make_parts() {
    sort_triangles();
    vertex_seen_.assign(patch_.vertex_count(), kNone);
    part_above_.resize(levels_.size());
    part_below_.resize(levels_.size());
    std::vector<std::uint32_t> part_of(patch_.edge_count(), kNone);
    for (std::size_t slab = 0; slab <= levels_.size(); ++slab) {
      join_slab(slab);
      for (const std::uint32_t e : slice_.used()) {
        const std::uint32_t root = slice_.find(e);
        if (part_of[root] == kNone) {
          part_of[root] = static_cast<std::uint32_t>(parts_.size());
          parts_.emplace_back();
        }
        Part& part = parts_[part_of[root]];
        const auto& edge = patch_.edge(e);
        if (slab == 0) part.at_v |= (edge.a == v_ || edge.b == v_);
        if (slab == levels_.size()) part.at_y |= (edge.a == y_ || edge.b == y_);
        part.at_rim |= patch_.at_rim(e) && patch_.triangles_at_edge(e).size() == 1;
        // The parts on both sides of a contour, by the edges that cross it.
        if (slab > 0 && crosses(e, slab - 1)) part_above_[slab - 1].emplace_back(e, part_of[root]);
        if (slab < levels_.size() && crosses(e, slab)) part_below_[slab].emplace_back(e, part_of[root]);
      }
      for (const std::uint32_t e : slice_.used()) part_of[slice_.find(e)] = kNone;
    }
  }

  void make_contours() {
    std::vector<std::uint32_t> contour_of(patch_.edge_count(), kNone), above(patch_.edge_count(), kNone);
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      join_level(level);
      for (const auto& [e, part] : part_above_[level]) above[e] = part;
      for (const auto& [e, part] : part_below_[level]) {
        const std::uint32_t root = slice_.find(e);
        if (contour_of[root] == kNone) {
          contour_of[root] = static_cast<std::uint32_t>(contours_.size());
          contours_.push_back({static_cast<std::uint32_t>(level), root, part, above[e], 0, ContourEnd::kCloses});
        }
        Contour& contour = contours_[contour_of[root]];
        if (patch_.triangles_at_edge(e).size() == 1)
          contour.end = std::max(contour.end, patch_.at_rim(e) ? ContourEnd::kRim : ContourEnd::kBoundary);
      }
      for (const std::uint32_t t : triangles_at(level)) add_length(level, t, contour_of);
      for (const auto& [e, part] : part_below_[level]) contour_of[slice_.find(e)] = kNone;
    }
  }

  // Where the level crosses the edge.
  Point point_at(std::size_t level, std::uint32_t e) const {
    const std::uint32_t rank = levels_[level] / 2;
    const double value = values_[heights_.by_rank[rank]] / 2 + values_[heights_.by_rank[rank + 1]] / 2;
    const auto& edge = patch_.edge(e);
    const double from = values_[edge.a], to = values_[edge.b];
    const double part = from == to ? 0.5 : std::clamp((value - from) / (to - from), 0.0, 1.0);
    Point point{};
    for (std::size_t k = 0; k < 3; ++k)
      point[k] = patch_.position(edge.a)[k] * (1 - part) + patch_.position(edge.b)[k] * part;
    return point;
  }

  void add_length(std::size_t level, std::uint32_t t, const std::vector<std::uint32_t>& contour_of) {
    std::array<Point, 2> ends{};
    std::size_t count = 0;
    std::uint32_t root = kNone;
    for (const std::uint32_t e : patch_.edges_of(t)) {
      if (!crosses(e, level) || count == 2) continue;
      root = slice_.find(e);
      ends[count++] = point_at(level, e);
    }
    if (count == 2) contours_[contour_of[root]].length += distance(ends[0], ends[1]);
  }

  const SurfacePatch& patch_;
  std::span<const double> values_;
  Heights heights_;
  std::uint32_t v_, y_;
  Slice slice_;
  std::vector<Place> levels_;
  std::vector<std::uint32_t> slab_first_, slab_triangles_, vertex_seen_;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> part_above_, part_below_;
  std::vector<Part> parts_;
  std::vector<Contour> contours_;
};

// A graph with numbered edges, and those of them that every path from one node to another uses.
class Bridges {
 public:
  explicit Bridges(std::uint32_t nodes) : at_(nodes) {}

  void join(std::uint32_t a, std::uint32_t b, std::uint32_t number) {
    at_[a].push_back({b, number});
    at_[b].push_back({a, number});
  }

  // The numbers of the edges between; kNone is the number of edges that do not count. Empty if nothing leads there.
  std::vector<std::uint32_t> between(std::uint32_t from, std::uint32_t to) const {
    // Depth first: `low` is the earliest node that the nodes below can reach by another way.
    std::vector<std::uint32_t> entered(at_.size(), kNone), low(at_.size(), 0), next(at_.size(), 0);
    std::vector<std::uint8_t> leads(at_.size(), 0);
    std::vector<std::pair<std::uint32_t, Step>> stack;  // node, and the step to it
    std::vector<std::uint32_t> result;
    std::uint32_t time = 0;
    stack.push_back({from, {kNone, kNone}});
    while (!stack.empty()) {
      const auto [node, step] = stack.back();
      if (entered[node] == kNone) {
        entered[node] = low[node] = time++;
        leads[node] = node == to ? 1 : 0;
      }
      if (next[node] < at_[node].size()) {
        const Step ahead = at_[node][next[node]++];
        if (entered[ahead.node] == kNone)
          stack.push_back({ahead.node, {node, ahead.number}});
        else if (!(ahead.node == step.node && ahead.number == step.number))
          low[node] = std::min(low[node], entered[ahead.node]);
        continue;
      }
      stack.pop_back();
      if (step.node == kNone) continue;
      low[step.node] = std::min(low[step.node], low[node]);
      leads[step.node] |= leads[node];
      if (leads[node] != 0 && low[node] > entered[step.node] && step.number != kNone) result.push_back(step.number);
    }
    return result;
  }

 private:
  struct Step {
    std::uint32_t node, number;
  };
  std::vector<std::vector<Step>> at_;
};

// The parts of the interlevel set in the patch, each connected there.
struct Components {
  UnionFind of_part;
  std::vector<std::uint8_t> at_v, at_y, at_rim;

  explicit Components(const Slabs& slabs)
      : of_part(static_cast<std::uint32_t>(slabs.parts().size())),
        at_v(slabs.parts().size(), 0),
        at_y(at_v),
        at_rim(at_v) {
    for (const Contour& contour : slabs.contours()) of_part.unite(contour.below, contour.above);
    for (std::uint32_t p = 0; p < at_v.size(); ++p) {
      const std::uint32_t c = of_part.find(p);
      if (slabs.parts()[p].at_v) at_v[c] = 1;
      if (slabs.parts()[p].at_y) at_y[c] = 1;
      if (slabs.parts()[p].at_rim) at_rim[c] = 1;
    }
  }
};

// The contours that every way from v to y within one component crosses.
std::vector<std::uint32_t> cutting_contours(const Slabs& slabs, Components& components, const LoopNodes& nodes) {
  const auto& parts = slabs.parts();
  const auto& contours = slabs.contours();
  const auto count = static_cast<std::uint32_t>(parts.size());
  const auto &at_v = components.at_v, &at_y = components.at_y, &at_rim = components.at_rim;
  std::vector<std::uint32_t> result;
  for (std::uint32_t c = 0; c < count; ++c) {
    if (components.of_part.find(c) != c) continue;
    const bool both = at_v[c] != 0 && at_y[c] != 0;
    if (!both && at_rim[c] == 0) continue;
    // What is outside the patch can be joined with y (or v) there.
    const auto cut = [&](bool from_v, bool with_rim) {
      const std::uint32_t from = count, to = count + 1;
      Bridges graph(count + 2);
      for (std::uint32_t p = 0; p < count; ++p) {
        if (components.of_part.find(p) != c) continue;
        if (from_v ? parts[p].at_v : parts[p].at_y) graph.join(from, p, kNone);
        if ((from_v ? parts[p].at_y : parts[p].at_v) || (with_rim && parts[p].at_rim)) graph.join(p, to, kNone);
      }
      for (std::uint32_t i = 0; i < contours.size(); ++i)
        if (components.of_part.find(contours[i].below) == c) graph.join(contours[i].below, contours[i].above, i);
      return graph.between(from, to);
    };
    // A third arc at a node can lead anywhere: then the other node must be seen.
    for (const bool from_v : {true, false})
      if ((from_v ? at_v[c] : at_y[c]) != 0 && (both || (from_v ? nodes.lo_divides : nodes.hi_joins)))
        for (const std::uint32_t i : cut(from_v, true)) result.push_back(i);
    if (both && at_rim[c] != 0 && result.empty())
      for (const std::uint32_t i : cut(true, false)) result.push_back(i);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Which of the two components each part belongs to: 1 or 2, or 0 if the patch does not tell. By the two arcs at v, and
// those at y if one of them is seen to be joined with v, or the other way round. Empty if neither node tells.
std::vector<std::uint8_t> sides_of_parts(Components& components, const LoopNodes& nodes, bool from_v) {
  const auto two_at = [&](const std::vector<std::uint8_t>& at, bool two_arcs) {
    std::vector<std::uint32_t> result;
    for (std::uint32_t c = 0; c < at.size(); ++c)
      if (at[c] != 0) result.push_back(c);
    if (!two_arcs || result.size() != 2) result.clear();
    return result;
  };
  const auto near = from_v ? two_at(components.at_v, nodes.lo_divides) : two_at(components.at_y, nodes.hi_joins);
  const auto far = from_v ? two_at(components.at_y, nodes.hi_joins) : two_at(components.at_v, nodes.lo_divides);
  if (near.empty()) return {};
  std::vector<std::uint8_t> of_root(components.at_v.size(), 0);
  of_root[near[0]] = 1;
  of_root[near[1]] = 2;
  for (std::size_t i = 0; i < far.size(); ++i)
    if (of_root[far[i]] != 0) of_root[far[1 - i]] = static_cast<std::uint8_t>(3 - of_root[far[i]]);
  std::vector<std::uint8_t> result(of_root.size(), 0);
  for (std::uint32_t p = 0; p < result.size(); ++p) result[p] = of_root[components.of_part.find(p)];
  return result;
}

// All of one component at some level, at those levels where most is known.
std::vector<LoopContour> component_cuts(const Slabs& slabs, Components& components, const LoopNodes& nodes) {
  constexpr std::size_t kMostLevels = 2;
  std::vector<LoopContour> result;
  for (const bool from_v : {true, false}) {
    const std::vector<std::uint8_t> side = sides_of_parts(components, nodes, from_v);
    if (side.empty()) continue;
    std::vector<std::tuple<std::size_t, std::size_t, std::size_t>> levels;
    for (std::size_t level = 0; level < slabs.level_count(); ++level) {
      const auto [unknown, one, two] = slabs.count_at(level, side);
      if (one != 0 && two != 0) levels.emplace_back(unknown, std::min(one, two), level);
    }
    std::sort(levels.begin(), levels.end());
    for (std::size_t i = 0; i < std::min(levels.size(), kMostLevels); ++i) {
      const auto& [unknown, gates, level] = levels[i];
      const auto count = slabs.count_at(level, side);
      result.push_back(slabs.sides_at(level, side, count[1] <= count[2] ? 1 : 2));
      // All other levels are as good.
      if (unknown == 0) return {result.back()};
    }
  }
  return result;
}

}  // namespace

CurvePlace curve_place(std::span<const Point> points) {
  CurvePlace place{{points[0], points[0]}, {}};
  auto& [least, most] = place.box;
  for (const Point& point : points)
    for (std::size_t k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], point[k]);
      most[k] = std::max(most[k], point[k]);
      place.center[k] += point[k] / static_cast<double>(points.size());
    }
  // Rounding must not move the centre out of a flat box.
  for (std::size_t k = 0; k < 3; ++k) place.center[k] = std::clamp(place.center[k], least[k], most[k]);
  return place;
}

std::vector<LoopContour> loop_contours(const SurfacePatch& patch, std::span<const double> values,
                                       const LoopNodes& nodes) {
  Slabs slabs(patch, values, nodes.lo, nodes.hi);
  Components components(slabs);
  const std::vector<std::uint32_t> cutting = cutting_contours(slabs, components, nodes);
  const auto& contours = slabs.contours();
  const auto shortest = std::ranges::min_element(
      cutting, {}, [&](std::uint32_t i) { return std::tuple(contours[i].end, contours[i].length, i); });
  if (shortest != cutting.end() && contours[*shortest].end != ContourEnd::kRim)
    return {slabs.trace(contours[*shortest])};
  return component_cuts(slabs, components, nodes);
}

}  // namespace reeb
