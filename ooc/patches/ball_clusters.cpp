#include "ooc/patches/ball_clusters.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "libreeb/base/union_find.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb::ooc {

std::vector<std::vector<std::uint32_t>> clusters_of(std::span<const Ball> balls) {
  std::vector<std::uint32_t> order(balls.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto low = [&](std::uint32_t i) { return balls[i].center[0] - balls[i].radius; };
  const auto high = [&](std::uint32_t i) { return balls[i].center[0] + balls[i].radius; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return low(a) < low(b); });
  UnionFind cluster(static_cast<std::uint32_t>(balls.size()));
  std::vector<std::uint32_t> active;
  for (const std::uint32_t i : order) {
    std::erase_if(active, [&](std::uint32_t other) { return high(other) < low(i); });
    for (const std::uint32_t other : active)
      if (distance(balls[i].center, balls[other].center) <= balls[i].radius + balls[other].radius)
        cluster.unite(i, other);
    active.push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<std::uint32_t> number(balls.size(), 0);
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    const std::uint32_t root = cluster.find(i);
    if (root == i) {
      number[i] = static_cast<std::uint32_t>(result.size());
      result.emplace_back();
    }
    result[number[root]].push_back(i);
  }
  return result;
}

}  // namespace reeb::ooc
