// The embedding of an arc: the positions of the vertices along it, by buckets of function value
// (docs/SEMANTICS.md, Buckets; the paper's "Embedding").
//
// Bucket i of exponent h covers the values [i * 2^h, (i + 1) * 2^h). Buckets 2i and 2i + 1 of exponent h together are
// bucket i of exponent h + 1.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace reeb {

// The vertex of a bucket that is the greatest by x, then y, then z, in single precision: a point of the surface that
// moves little from one bucket to the next.
using RimPoint = std::array<float, 3>;

struct Bucket {
  std::int64_t index = 0;
  std::uint64_t count = 0;       // vertices
  std::array<double, 3> mean{};  // of their positions
  // Of a single vertex, both are zeros: see rim_of().
  float spread = 0;  // the mean squared distance of the positions from their mean
  RimPoint rim{};
  friend bool operator==(const Bucket&, const Bucket&) = default;
};

// What is stored of a mean squared distance, which rounding may have made negative.
float to_spread(double spread) noexcept;

// The position in single precision, without -0, so that equal points have equal bits. REQUIRES: its coordinates are at
// most 2^50, which need no care.
inline RimPoint near_rim_of(const std::array<double, 3>& position) {
  return {static_cast<float>(position[0]) + 0.0F, static_cast<float>(position[1]) + 0.0F,
          static_cast<float>(position[2]) + 0.0F};
}
// The same for any finite position: a coordinate beyond the floats is the largest of them.
inline RimPoint rim_of(const std::array<double, 3>& position) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return near_rim_of({std::clamp(position[0], -kMost, kMost), std::clamp(position[1], -kMost, kMost),
                      std::clamp(position[2], -kMost, kMost)});
}
// REQUIRES: count != 0.
inline RimPoint rim_of(const Bucket& bucket) { return bucket.count == 1 ? rim_of(bucket.mean) : bucket.rim; }

// The bucket with this number of its vertices, 1 at least, for a bucket that is divided.
inline Bucket part_of(Bucket bucket, std::uint64_t count) {
  bucket.count = count;
  if (count == 1) {
    bucket.spread = 0;
    bucket.rim = {};
  }
  return bucket;
}

// The bucket of this value: floor(value / 2^exponent).
// REQUIRES: the exponent is at least bucket_exponent() of a range with the value.
std::int64_t bucket_index(double value, int exponent) noexcept;

// The same for many values of one exponent.
class BucketIndexer {
 public:
  explicit BucketIndexer(int exponent = 0) noexcept;
  std::int64_t operator()(double value) const noexcept {
    if (scale_ == 0) return bucket_index(value, exponent_);
    const double scaled = value * scale_;
    const auto cut_off = static_cast<std::int64_t>(scaled);
    return cut_off - (scaled < static_cast<double>(cut_off) ? 1 : 0);
  }
  int exponent() const noexcept { return exponent_; }
  // 2^-exponent, or 0 if that is not well within the normal numbers.
  double scale() const noexcept { return scale_; }

 private:
  int exponent_;
  double scale_;
};

// Of the buckets over a range of values.
inline constexpr std::uint32_t kMostBuckets = 1u << 20;

// The least exponent for which the values from min to max are in at most 2 * buckets consecutive buckets whose indices
// are exact. So they are in about `buckets` of them or more, unless there are too few numbers between min and max. The
// exponent never falls when the range grows.
// REQUIRES: min <= max, finite; 1 <= buckets <= kMostBuckets.
int bucket_exponent(double min, double max, std::uint32_t buckets) noexcept;

// Adds `other` to `bucket`: counts add up, the mean is weighted by them. REQUIRES: equal indices.
void merge_into(Bucket& bucket, const Bucket& other) noexcept;

// Raises the exponent of buckets[first] and all after it by `levels`. REQUIRES: they ascend by index. O(buckets).
void coarsen(std::vector<Bucket>& buckets, std::size_t first, unsigned levels);

}  // namespace reeb
