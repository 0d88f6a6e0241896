#include "libreeb/defects/odd_cycle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace reeb {
namespace {

// Gates that are nearer to each other than this share of the path are not all searched: those far from the best path,
// and those near it.
constexpr double kGateSpacing = 0.1, kLeastSpacing = 0.04;

// Shortest paths from one gate after the other, and the shortest closed path that an edge between two of them makes.
// There is one: along the shortest odd path the tree's parities do not all agree, and at an edge where they differ, the
// tree's paths to its two ends are no longer than the two parts of that path.
class OddSearch {
 public:
  OddSearch(const SurfacePatch& patch, const Crossings& crossings, std::span<const std::uint8_t> allowed)
      : patch_(patch),
        crossings_(crossings),
        allowed_(allowed.begin(), allowed.end()),
        distance_(patch.vertex_count(), kFar),
        settled_(patch.vertex_count(), 0),
        parity_(patch.vertex_count(), 0),
        from_(patch.vertex_count(), SurfacePatch::kNone) {}

  // The shortest odd path through the gate if it is shorter than `bound`. Without the way from the gate and back that
  // it may begin and end with.
  ClosedPath search(std::uint32_t gate, double bound) {
    for (const std::uint32_t v : touched_) {
      distance_[v] = kFar;
      settled_[v] = 0;
    }
    touched_.assign(1, gate);
    queue_.clear();
    push(0, gate);
    distance_[gate] = 0;
    parity_[gate] = 0;
    from_[gate] = SurfacePatch::kNone;
    std::uint32_t closing = SurfacePatch::kNone;
    while (!queue_.empty()) {
      const auto [length, v] = pop();
      if (settled_[v] != 0) continue;
      if (2 * length >= bound) break;
      settled_[v] = 1;
      for (const std::uint32_t e : patch_.edges_at(v)) {
        const auto& edge = patch_.edge(e);
        const std::uint32_t other = edge.a == v ? edge.b : edge.a;
        if (allowed_[other] == 0 || crossings_[e] == kBarred) continue;
        const auto parity = static_cast<std::uint8_t>(parity_[v] ^ crossings_[e]);
        const double there = length + edge.length;
        if (settled_[other] != 0) {
          if (parity == parity_[other] || there + distance_[other] >= bound) continue;
          bound = there + distance_[other];
          closing = e;
        } else if (there < distance_[other]) {
          if (distance_[other] == kFar) touched_.push_back(other);
          distance_[other] = there;
          parity_[other] = parity;
          from_[other] = v;
          push(there, other);
        }
      }
    }
    return closing == SurfacePatch::kNone ? ClosedPath{} : path_through(closing);
  }

  // Paths through this vertex are known.
  void remove(std::uint32_t vertex) { allowed_[vertex] = 0; }
  // There is no odd path through what the last search reached.
  void remove_reached() {
    for (const std::uint32_t v : touched_) allowed_[v] = 0;
  }
  bool allows(std::uint32_t vertex) const { return allowed_[vertex] != 0; }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  using Entry = std::pair<double, std::uint32_t>;

  void push(double length, std::uint32_t v) {
    queue_.emplace_back(length, v);
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
  }
  Entry pop() {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const Entry entry = queue_.back();
    queue_.pop_back();
    return entry;
  }

  std::vector<std::uint32_t> way_to(std::uint32_t v) const {
    std::vector<std::uint32_t> way;
    for (; v != SurfacePatch::kNone; v = from_[v]) way.push_back(v);
    std::reverse(way.begin(), way.end());
    return way;
  }

  ClosedPath path_through(std::uint32_t closing) const {
    const auto& edge = patch_.edge(closing);
    const std::vector<std::uint32_t> there = way_to(edge.a), back = way_to(edge.b);
    std::size_t common = 1;
    while (common < there.size() && common < back.size() && there[common] == back[common]) ++common;
    ClosedPath path;
    path.vertices.assign(there.begin() + static_cast<std::ptrdiff_t>(common) - 1, there.end());
    path.vertices.insert(path.vertices.end(), back.rbegin(), back.rend() - static_cast<std::ptrdiff_t>(common));
    path.length = distance_[edge.a] + edge.length + distance_[edge.b] - 2 * distance_[there[common - 1]];
    return path;
  }

  const SurfacePatch& patch_;
  const Crossings& crossings_;
  std::vector<std::uint8_t> allowed_;
  std::vector<double> distance_;
  std::vector<std::uint8_t> settled_, parity_;
  std::vector<std::uint32_t> from_, touched_;
  std::vector<Entry> queue_;
};

// Turns around x from its neighbour `from` to its neighbour `to`, leaving out both; calls visit(edge) on the way.
// Returns false where the fan ends or is not an oriented surface.
template <class Visit>
bool turn(const SurfacePatch& patch, std::uint32_t x, std::uint32_t from, std::uint32_t to, const Visit& visit) {
  std::uint32_t at = from;
  for (std::size_t steps = patch.edges_at(x).size() + 1; steps-- > 0;) {
    const std::uint32_t e = patch.edge_between(x, at);
    if (e == SurfacePatch::kNone || !patch.consistent(e)) return false;
    if (at != from) visit(e);
    std::uint32_t next = SurfacePatch::kNone;
    for (const std::uint32_t t : patch.triangles_at_edge(e)) {
      const auto c = patch.oriented(t);
      for (std::size_t i = 0; i < 3; ++i)
        if (c[i] == x && c[(i + 1) % 3] == at) next = c[(i + 2) % 3];
    }
    if (next == SurfacePatch::kNone) return false;
    at = next;
    if (at == to) return true;
  }
  return false;
}

}  // namespace

std::vector<std::uint8_t> whole_vertices(const SurfacePatch& patch) {
  std::vector<std::uint8_t> result(patch.vertex_count(), 0);
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v) result[v] = patch.whole(v) ? 1 : 0;
  return result;
}

std::vector<std::uint8_t> inner_vertices(const SurfacePatch& patch) {
  std::vector<std::uint8_t> result = whole_vertices(patch);
  for (std::uint32_t e = 0; e < patch.edge_count(); ++e)
    if (!patch.consistent(e)) result[patch.edge(e).a] = result[patch.edge(e).b] = 0;
  return result;
}

ClosedPath shortest_odd_cycle(const SurfacePatch& patch, const Crossings& crossings,
                              std::span<const std::uint32_t> gates, std::span<const std::uint8_t> allowed,
                              double longest) {
  OddSearch odd(patch, crossings, allowed);
  ClosedPath best;
  std::vector<std::uint32_t> searched;
  const auto search = [&](std::uint32_t gate, double spacing) {
    const double bound = std::min(best.length, longest);
    const auto is_near = [&](std::uint32_t other) {
      return distance(patch.position(gate), patch.position(other)) < spacing * bound;
    };
    if (!odd.allows(gate) || (std::isfinite(bound) && std::ranges::any_of(searched, is_near))) return;
    searched.push_back(gate);
    ClosedPath path = odd.search(gate, bound);
    if (path.length < best.length)
      best = std::move(path);
    else if (!std::isfinite(bound))
      odd.remove_reached();
    odd.remove(gate);
  };
  for (const std::uint32_t gate : gates) search(gate, kGateSpacing);
  // Then all gates near the best path.
  if (!best.exists()) return best;
  const ClosedPath rough = best;
  for (const std::uint32_t gate : gates) {
    const auto is_near = [&](std::uint32_t v) {
      return distance(patch.position(gate), patch.position(v)) < kGateSpacing * rough.length;
    };
    if (std::ranges::any_of(rough.vertices, is_near)) search(gate, kLeastSpacing);
  }
  return best;
}

ClosedPath shortest_odd_arc(const SurfacePatch& patch, const Crossings& crossings) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> length(2 * std::size_t{patch.vertex_count()}, kFar);
  std::vector<std::uint32_t> from(length.size(), SurfacePatch::kNone);
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v)
    if (!patch.whole(v)) queue.emplace(length[2 * std::size_t{v}] = 0, 2 * v);
  while (!queue.empty()) {
    const auto [so_far, state] = queue.top();
    queue.pop();
    const std::uint32_t v = state / 2;
    if (so_far > length[state]) continue;
    if (!patch.whole(v) && state % 2 != 0) {
      ClosedPath arc{{}, so_far};
      for (std::uint32_t s = state; s != SurfacePatch::kNone; s = from[s]) arc.vertices.push_back(s / 2);
      return arc;
    }
    for (const std::uint32_t e : patch.edges_at(v)) {
      const auto& edge = patch.edge(e);
      const std::uint32_t other = edge.a == v ? edge.b : edge.a, next = 2 * other + ((state & 1) ^ crossings[e]);
      if ((!patch.whole(v) && !patch.whole(other)) || so_far + edge.length >= length[next]) continue;
      length[next] = so_far + edge.length;
      from[next] = state;
      queue.emplace(length[next], next);
    }
  }
  return {};
}

namespace {

// Marks the edges to the left of `x` on a path. False where the patch is not an oriented manifold.
bool mark_left(const SurfacePatch& patch, std::uint32_t before, std::uint32_t x, std::uint32_t after, Crossings& left) {
  std::size_t turned = 0;
  const auto count = [&](std::uint32_t) { ++turned; };
  const auto mark = [&](std::uint32_t e) {
    ++turned;
    left[e] ^= 1;
  };
  // Both sides together are the whole fan, or there is a second fan at x.
  return turn(patch, x, after, before, mark) && turn(patch, x, before, after, count) &&
         turned + 2 == patch.edges_at(x).size();
}

}  // namespace

std::vector<std::uint32_t> fan_of(const SurfacePatch& patch, std::uint32_t vertex) {
  const auto at = patch.edges_at(vertex);
  if (at.empty()) return {};
  const auto& edge = patch.edge(at[0]);
  const std::uint32_t other = edge.a == vertex ? edge.b : edge.a;
  std::vector<std::uint32_t> fan = {at[0]};
  if (!turn(patch, vertex, other, other, [&](std::uint32_t e) { fan.push_back(e); }) || fan.size() != at.size())
    return {};
  return fan;
}

std::optional<Crossings> left_of(const SurfacePatch& patch, const ClosedPath& path) {
  Crossings left(patch.edge_count(), 0);
  const auto& x = path.vertices;
  if (x.size() < 3) return std::nullopt;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!mark_left(patch, x[(i + x.size() - 1) % x.size()], x[i], x[(i + 1) % x.size()], left)) return std::nullopt;
  return left;
}

bool bound_together(const SurfacePatch& patch, const Crossings& one, const Crossings& other) {
  // The part is on one side of both: its vertices are those reached from the rim across an odd number of curves.
  constexpr std::uint8_t kUnknown = 2;
  std::vector<std::uint8_t> side(patch.vertex_count(), kUnknown);
  std::vector<std::uint32_t> reached;
  const auto spread = [&] {
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const std::uint32_t e : patch.edges_at(reached[i])) {
        const auto& edge = patch.edge(e);
        const std::uint32_t next = edge.a == reached[i] ? edge.b : edge.a;
        const auto expected = static_cast<std::uint8_t>(side[reached[i]] ^ one[e] ^ other[e]);
        if (side[next] == kUnknown) {
          side[next] = expected;
          reached.push_back(next);
        } else if (side[next] != expected) {
          return false;
        }
      }
    return true;
  };
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v)
    if (!patch.whole(v)) {
      side[v] = 0;
      reached.push_back(v);
    }
  if (!spread()) return false;
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v)
    if (side[v] == kUnknown) {
      side[v] = 0;
      reached.assign(1, v);
      if (!spread()) return false;
    }
  return true;
}

std::optional<Crossings> left_of_arc(const SurfacePatch& patch, const ClosedPath& arc) {
  Crossings left(patch.edge_count(), 0);
  const auto& x = arc.vertices;
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    if (x[i - 1] == x[i + 1] || !mark_left(patch, x[i - 1], x[i], x[i + 1], left)) return std::nullopt;
  return left;
}

}  // namespace reeb
