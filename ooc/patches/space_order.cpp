#include "ooc/patches/space_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "ooc/whole_mesh/hilbert.h"

namespace reeb::ooc {

std::vector<std::uint32_t> order_in_space(std::span<const Point> points) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Point low = {kFar, kFar, kFar}, high = {-kFar, -kFar, -kFar};
  for (const Point& point : points)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  double side = 0;
  for (std::size_t k = 0; k < 3; ++k) side = std::max(side, high[k] / 2 - low[k] / 2);
  constexpr double kCells = 1u << kHilbertBits;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
  keyed.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = side > 0 ? (points[i][k] / 2 - low[k] / 2) / side : 0;
      cell[k] = static_cast<std::uint32_t>(std::min(share * kCells, kCells - 1));
    }
    keyed.emplace_back(hilbert_index(cell), i);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (const auto& [key, i] : keyed) order.push_back(i);
  return order;
}

}  // namespace reeb::ooc
