// The sizes at which a frame under construction is full: estimates of its uncompressed columns.
#pragma once

#include <cstddef>

namespace reeb::ooc {

inline constexpr std::size_t kFrameTargetBytes = 128 << 10;
inline constexpr std::size_t kNodeCost = 36, kArcCost = 6, kVersionCost = 11, kBucketCost = 43;
inline constexpr std::size_t kPairsPerFrame = 32768;

}  // namespace reeb::ooc
