#include "ooc/patches/ball_clusters.h"

#include "libreeb/containers/union_find.h"
#include "ooc/patches/near_balls.h"

namespace reeb::ooc {

std::vector<std::vector<std::uint32_t>> clusters_of(std::span<const Ball> balls) {
  UnionFind cluster(static_cast<std::uint32_t>(balls.size()));
  NearBalls before;
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    for (const std::uint32_t other : before.meeting(balls[i])) cluster.unite(i, other);
    before.add(balls[i], i);
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
