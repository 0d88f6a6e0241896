#include "libreeb/repair/nearby_loop.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "libreeb/base/vector3.h"
#include "libreeb/containers/union_find.h"
#include "libreeb/repair/shortest_paths.h"

namespace reeb {
namespace {

using Vertices = std::vector<std::uint32_t>;

// The way to a, and back from b; empty if they share more than their beginning.
Vertices around(const ShortestPaths& paths, std::uint32_t a, std::uint32_t b) {
  Vertices there = paths.path_to(a), back = paths.path_to(b);
  Vertices sorted = there;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < back.size(); ++i)
    if (std::ranges::binary_search(sorted, back[i])) return {};
  there.insert(there.end(), back.rbegin(), back.rend() - 1);
  return there;
}

bool divides(const EditablePatch& patch, const Vertices& curve) {
  std::vector<std::uint32_t> place(patch.vertex_count(), EditablePatch::kNone);
  for (std::uint32_t i = 0; i < curve.size(); ++i) place[curve[i]] = i;
  const auto is_on_curve = [&](std::uint32_t a, std::uint32_t b) {
    if (place[a] == EditablePatch::kNone || place[b] == EditablePatch::kNone) return false;
    const std::uint32_t low = std::min(place[a], place[b]), high = std::max(place[a], place[b]);
    return high - low == 1 || (low == 0 && high + 1 == curve.size());
  };
  std::vector<std::uint32_t> sides;
  patch.for_each_at_edge(curve[0], curve[1], [&](std::uint32_t t) { sides.push_back(t); });
  if (sides.size() != 2) return true;
  std::vector<std::uint8_t> seen(patch.triangle_count(), 0);
  Vertices open = {sides[0]};
  seen[sides[0]] = 1;
  while (!open.empty()) {
    const std::uint32_t t = open.back();
    open.pop_back();
    const auto& c = patch.triangle(t).corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = c[i], b = c[(i + 1) % 3];
      if (is_on_curve(a, b)) continue;
      const std::uint32_t other = patch.across(t, a, b);
      if (other == EditablePatch::kNone || seen[other] != 0) continue;
      if (other == sides[1]) return false;
      seen[other] = 1;
      open.push_back(other);
    }
  }
  return true;
}

// The shortest loops through one vertex that bound no disc: a tree of paths, and a tree of triangles that crosses the
// other edges, those of long loops first, leave few edges (Erickson and Whittlesey 2005).
Vertices loop_through(const EditablePatch& patch, std::uint32_t from, double& most) {
  // Over vertices whose triangles are all in the patch.
  const ShortestPaths paths(patch, from, most / 2, [&](std::uint32_t v) { return patch.vertex(v).whole; });
  struct Candidate {
    double length;
    std::uint32_t a, b, t, u;
  };
  std::vector<Candidate> candidates;
  for (const std::uint32_t a : paths.reached())
    patch.for_each_at(a, [&](std::uint32_t t) {
      for (const std::uint32_t b : patch.triangle(t).corners) {
        if (b <= a || !paths.reaches(b) || paths.uses(a, b)) continue;
        const std::uint32_t u = patch.across(t, a, b);
        if (u == EditablePatch::kNone || u < t) continue;
        const double length = paths.length(a) + paths.length(b) + distance(patch.position(a), patch.position(b));
        candidates.push_back({length, a, b, t, u});
      }
    });
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
    return std::tie(x.length, x.a, x.b) > std::tie(y.length, y.a, y.b);
  });
  // What is farther away counts as one piece; where it is several, a few more edges are left.
  const auto far = static_cast<std::uint32_t>(patch.triangle_count());
  UnionFind joined(far + 1);
  for (const std::uint32_t v : paths.reached())
    patch.for_each_at(v, [&](std::uint32_t t) {
      if (!std::ranges::all_of(patch.triangle(t).corners, [&](std::uint32_t w) { return paths.reaches(w); }))
        joined.unite(t, far);
    });
  std::vector<Candidate> left;
  for (const Candidate& candidate : candidates)
    if (!joined.unite(candidate.t, candidate.u)) left.push_back(candidate);
  for (auto it = left.rbegin(); it != left.rend() && it->length < most; ++it) {
    Vertices loop = around(paths, it->a, it->b);
    if (loop.size() < 3 || divides(patch, loop)) continue;
    most = it->length;
    return loop;
  }
  return {};
}

}  // namespace

std::vector<std::uint32_t> nearby_loop(const EditablePatch& patch, std::span<const std::uint32_t> near, double most) {
  constexpr std::size_t kMostStarts = 12;
  Vertices best;
  for (std::size_t i = 0; i < near.size(); i += 1 + near.size() / kMostStarts) {
    const std::uint32_t v = near[i];
    if (!patch.vertex(v).whole || !patch.is_used(v)) continue;
    if (Vertices loop = loop_through(patch, v, most); !loop.empty()) best = std::move(loop);
  }
  return best;
}

}  // namespace reeb
