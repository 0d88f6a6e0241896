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

struct alignas(32) WideSum {
  // x, y, z and the number of vertices, in units of 2^-44.
  std::array<double, 4> high{}, low{};
  std::array<float, 4> rim = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF, 0};  // and a number that is not used
  double moment = 0;

  BucketSum to_bucket() const;  // without its index
};

// Whether this processor can run add_wide().
bool can_add_wide() noexcept;

// Adds vertex i, at positions[i], to sums[buckets[i]], or to the last sum if there is none of this number. Returns how
// many vertices it has added, from the first on. It stops before a vertex that is too far from the origin, after 2^19
// vertices, and before the last one. REQUIRES: can_add_wide(); there is a sum; there are as many buckets as positions.
std::size_t add_wide(std::span<WideSum> sums, std::span<const std::uint32_t> buckets, std::span<const Point> positions);

}  // namespace reeb
