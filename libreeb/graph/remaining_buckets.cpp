#include "libreeb/graph/remaining_buckets.h"

#include <algorithm>
#include <stdexcept>

#include "libreeb/graph/bucket_lists.h"
#include "libreeb/graph/packed_buckets.h"

namespace reeb {

void RemainingBuckets::start(Direction d, double start, double end, std::span<const std::byte> packed, int exponent) {
  buckets_.clear();
  if (!unpack_buckets(packed, buckets_)) throw std::logic_error("RemainingBuckets: a list cannot be read");
  if (d == kUp) std::reverse(buckets_.begin(), buckets_.end());
  direction_ = d;
  start_ = start;
  end_ = end;
  exponent_ = exponent;
}

void RemainingBuckets::cut(double at) {
  const bool up = direction_ == kUp;
  const auto [lo, hi] = std::minmax(start_, end_);
  const std::int64_t middle = bucket_index(at, exponent_);
  while (!empty() && (up ? buckets_.back().index < middle : buckets_.back().index > middle)) buckets_.pop_back();
  if (!empty() && buckets_.back().index == middle) {
    const std::uint64_t below = vertices_below(buckets_.back(), {lo, at, hi}, exponent_);
    const std::uint64_t rest = up ? buckets_.back().count - below : below;
    if (rest == 0)
      buckets_.pop_back();
    else
      buckets_.back() = part_of(buckets_.back(), rest);
  }
  start_ = at;
}

double RemainingBuckets::first_value() const {
  const auto [lo, hi] = std::minmax(start_, end_);
  return first_value_of(buckets_.back(), direction_, lo, hi, exponent_);
}

}  // namespace reeb
