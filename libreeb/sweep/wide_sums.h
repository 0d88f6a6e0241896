// Sums of positions that a processor with AVX2 adds up four numbers at a time: faster than BucketSum::add(), and with
// the same result to the last bit.
//
// A coordinate in units of 2^-44, rounded towards zero, is a whole number that a double can hold. It is divided into
// a multiple of 2^35 and a rest of at most 2^34. As coordinates are below 2^24, doubles hold the sums of both exactly
// for up to 2^19 vertices.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "libreeb/graph/bucket_sums.h"

namespace reeb {

// The three numbers of `high` and the moment are one vector, and so are those of `low` and the count.
struct WideSum {
  std::array<double, 3> high{};  // of x, y, z, in units of 2^-44
  double moment = 0;
  std::array<double, 3> low{};
  double count = 0;
  std::array<float, 4> rim = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF, 0};  // and a number that is not used

  BucketSum to_bucket() const;  // without its index
};
static_assert(offsetof(WideSum, moment) == 24 && offsetof(WideSum, low) == 32 && offsetof(WideSum, count) == 56);

inline constexpr std::size_t kMostWideVertices = std::size_t{1} << 19;

// Adds vertex i, at positions[i], to sums[buckets[i]], or to the last sum if there is none of this number. Returns how
// many vertices it has added, from the first on: all, unless there are more than kMostWideVertices, or one is too far
// from the origin. REQUIRES: has_avx2(); there is a sum; there are as many buckets as positions.
std::size_t add_wide(std::span<WideSum> sums, std::span<const std::uint32_t> buckets, std::span<const Point> positions);

}  // namespace reeb
