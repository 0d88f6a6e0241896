#include "libreeb/graph/bucket_lists.h"

#include <algorithm>
#include <cmath>

namespace reeb {

BucketSpan values_in_bucket(const Bucket& bucket, double lo, double hi, int exponent) {
  const auto index = static_cast<double>(bucket.index);
  return {std::max(lo, std::ldexp(index, exponent)), std::min(hi, std::ldexp(index + 1, exponent))};
}

double first_value_of(const Bucket& bucket, Direction d, double lo, double hi, int exponent) {
  const auto [bottom, top] = values_in_bucket(bucket, lo, hi, exponent);
  if (!(bottom < top)) return bottom;
  const double half_a_vertex = 0.5 / static_cast<double>(bucket.count) * (top - bottom);
  return d == kUp ? bottom + half_a_vertex : top - half_a_vertex;
}

std::uint64_t vertices_below(const Bucket& bucket, const CutValues& values, int exponent) {
  const auto [bottom, top] = values_in_bucket(bucket, values.lo, values.hi, exponent);
  if (!(bottom < top)) return bucket.count;
  const double share = std::clamp((values.at - bottom) / (top - bottom), 0.0, 1.0);
  return std::min(bucket.count, static_cast<std::uint64_t>(std::round(static_cast<double>(bucket.count) * share)));
}

}  // namespace reeb
