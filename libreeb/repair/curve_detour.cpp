#include "libreeb/repair/curve_detour.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "libreeb/defects/surface_patch.h"

namespace reeb {
namespace {

using Vertices = std::vector<std::uint32_t>;

// The vertices between two others on the shortest way that meets none of `taken`; false if there is none up to `most`.
bool way_between(const EditablePatch& patch, std::uint32_t from, std::uint32_t to,
                 const std::vector<std::uint8_t>& taken, double most, Vertices& way) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> length(patch.vertex_count(), kFar);
  Vertices before(patch.vertex_count(), EditablePatch::kNone);
  length[from] = 0;
  queue.emplace(0, from);
  while (!queue.empty()) {
    const auto [so_far, v] = queue.top();
    queue.pop();
    if (so_far > length[v]) continue;
    if (v == to) {
      way.clear();
      for (std::uint32_t x = before[to]; x != from; x = before[x]) way.push_back(x);
      std::reverse(way.begin(), way.end());
      return true;
    }
    patch.for_each_at(v, [&, at = v, done = so_far](std::uint32_t t) {
      for (const std::uint32_t w : patch.triangle(t).corners) {
        const double next = done + distance(patch.position(at), patch.position(w));
        if (w == at || (taken[w] != 0 && w != to) || next > most || next >= length[w]) continue;
        length[w] = next;
        before[w] = at;
        queue.emplace(next, w);
      }
    });
  }
  return false;
}

}  // namespace

std::vector<std::uint32_t> with_detours(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  constexpr double kMostDetour = 1.5;
  const auto length_of = [&](std::span<const std::uint32_t> path) {
    double sum = 0;
    for (std::size_t i = 0; i < path.size(); ++i)
      sum += distance(patch.position(path[i]), patch.position(path[(i + 1) % path.size()]));
    return sum;
  };
  const double most = kMostDetour * length_of(curve);
  Vertices left;
  for (const std::uint32_t v : curve)
    if (patch.is_used(v)) left.push_back(v);
  if (left.size() < 2) return {};
  std::vector<std::uint8_t> taken(patch.vertex_count(), 0);
  for (const std::uint32_t v : left) taken[v] = 1;
  Vertices result, way;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::uint32_t from = left[i], to = left[(i + 1) % left.size()];
    result.push_back(from);
    if (patch.has_edge(from, to)) continue;
    if (!way_between(patch, from, to, taken, most, way)) return {};
    for (const std::uint32_t v : way) taken[v] = 1;
    result.insert(result.end(), way.begin(), way.end());
  }
  return result.size() >= 3 && length_of(result) <= most ? result : Vertices{};
}

}  // namespace reeb
