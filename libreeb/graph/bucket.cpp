#include "libreeb/graph/bucket.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reeb {
namespace {

// 2^-exponent might overflow where the quotient does not.
double scaled(double value, int exponent) noexcept { return std::floor(std::ldexp(value, -exponent)); }

bool fits(double min, double max, std::uint32_t buckets, int exponent) noexcept {
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double first = scaled(min, exponent), last = scaled(max, exponent);
  return first >= -kExact && last <= kExact && last - first < 2.0 * buckets;
}

}  // namespace

float to_spread(double spread) noexcept {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(spread > 0 ? std::min(spread, kMost) : 0.0);
}

std::int64_t bucket_index(double value, int exponent) noexcept {
  return static_cast<std::int64_t>(scaled(value, exponent));
}

BucketIndexer::BucketIndexer(int exponent) noexcept
    : exponent_(exponent), scale_(-1000 < exponent && exponent < 1000 ? std::ldexp(1.0, -exponent) : 0) {}

int bucket_exponent(double min, double max, std::uint32_t buckets) noexcept {
  // Beyond the exponents of all doubles, so that the narrowest range can still be divided.
  int least = -1100, most = 1100;
  while (least < most) {
    const int middle = least + (most - least) / 2;
    if (fits(min, max, buckets, middle))
      most = middle;
    else
      least = middle + 1;
  }
  return least;
}

void merge_into(Bucket& bucket, const Bucket& other) noexcept {
  if (other.count == 0) return;
  const double all = static_cast<double>(bucket.count + other.count), share = static_cast<double>(other.count) / all;
  const RimPoint rim = bucket.count == 0 ? rim_of(other) : std::max(rim_of(bucket), rim_of(other));
  double distance = 0;  // of the means, squared
  // The first of two equal means stays as it is.
  for (std::size_t k = 0; k < bucket.mean.size(); ++k) {
    const double step = other.mean[k] - bucket.mean[k];
    distance += step * step;
    // A step may be beyond the doubles, the mean is not.
    bucket.mean[k] =
        std::isfinite(step) ? bucket.mean[k] + step * share : bucket.mean[k] * (1 - share) + other.mean[k] * share;
  }
  const double spread = bucket.spread + (other.spread - static_cast<double>(bucket.spread)) * share;
  bucket.spread = to_spread(spread + distance * share * (1 - share));
  bucket.count += other.count;
  bucket.rim = bucket.count == 1 ? RimPoint{} : rim;
}

void coarsen(std::vector<Bucket>& buckets, std::size_t first, unsigned levels) {
  if (levels == 0) return;
  std::size_t kept = first;
  for (std::size_t i = first; i < buckets.size(); ++i) {
    Bucket bucket = buckets[i];
    bucket.index = levels < 63 ? bucket.index >> levels : (bucket.index < 0 ? -1 : 0);
    if (kept > first && buckets[kept - 1].index == bucket.index)
      merge_into(buckets[kept - 1], bucket);
    else
      buckets[kept++] = bucket;
  }
  buckets.resize(kept);
}

}  // namespace reeb
