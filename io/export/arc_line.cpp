#include "io/export/arc_line.h"

#include <algorithm>
#include <cmath>

namespace reeb::io {
namespace {

struct Stop {
  std::array<double, 3> point;
  double weight;
};

// The node below, the non-empty buckets, the node above. A node has the weight of the bucket next to it.
std::vector<Stop> stops_of(const std::array<double, 3>& lo, std::span<const Bucket> buckets,
                           const std::array<double, 3>& hi) {
  std::vector<Stop> stops{{lo, 1}};
  for (const Bucket& bucket : buckets)
    if (bucket.count != 0) stops.push_back({bucket.mean, std::sqrt(static_cast<double>(bucket.count))});
  stops.push_back({hi, 1});
  stops.front().weight = stops[1].weight;
  stops.back().weight = stops[stops.size() - 2].weight;
  return stops;
}

}  // namespace

void draw_arc(const std::array<double, 3>& lo, std::span<const Bucket> buckets, const std::array<double, 3>& hi,
              std::vector<std::array<double, 3>>& line) {
  line.clear();
  const std::vector<Stop> stops = stops_of(lo, buckets, hi);
  const auto last = static_cast<std::ptrdiff_t>(stops.size()) - 1;
  const auto reach = std::min(static_cast<std::ptrdiff_t>(kLineReach), last / 3);
  for (std::ptrdiff_t i = 1; i < last; ++i) {
    std::array<double, 3> sum{};
    double weights = 0;
    for (std::ptrdiff_t j = -reach; j <= reach; ++j) {
      const Stop& stop = stops[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + j, 0, last))];
      const double weight = stop.weight * static_cast<double>(reach + 1 - std::abs(j));
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += weight * stop.point[axis];
      weights += weight;
    }
    line.push_back({sum[0] / weights, sum[1] / weights, sum[2] / weights});
  }
}

}  // namespace reeb::io
