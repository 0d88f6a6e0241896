#include "libreeb/sweep/sweep_graph.h"

#include <algorithm>
#include <cmath>

namespace reeb {

std::uint32_t SweptChunk::end_of_bucket(std::uint32_t v, std::int64_t index, int exponent) const {
  const double end = std::ldexp(static_cast<double>(index + 1), exponent);
  const auto rest = order.subspan(v + 1);
  const auto next = std::partition_point(rest.begin(), rest.end(), [&](std::uint32_t i) { return values[i] < end; });
  return v + 1 + static_cast<std::uint32_t>(next - rest.begin());
}

}  // namespace reeb
