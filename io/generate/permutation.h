// A pseudo-random permutation of 0..n-1 that is computed, not stored.
#pragma once

#include <bit>
#include <cstdint>

#include "io/generate/noise.h"

namespace reeb::io {

// A balanced Feistel network permutes the numbers below the next power of four. Cycle walking (applying it until the
// result is below n, fewer than 4 times on average) restricts it to n.
class Permutation {
 public:
  Permutation(std::uint64_t n, std::uint64_t seed)
      : n_(n), seed_(mix(seed)), half_bits_((static_cast<unsigned>(std::bit_width(n)) + 1) / 2) {}

  // REQUIRES: i < n. The results for all i are all numbers below n.
  std::uint64_t operator()(std::uint64_t i) const {
    do i = encrypt(i);
    while (i >= n_);
    return i;
  }

 private:
  static constexpr std::uint64_t kRounds = 4;

  std::uint64_t encrypt(std::uint64_t block) const {
    const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
    std::uint64_t left = block >> half_bits_, right = block & mask;
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      const std::uint64_t next = left ^ (hash_of(seed_, right, round) & mask);
      left = right;
      right = next;
    }
    return left << half_bits_ | right;
  }

  std::uint64_t n_, seed_;
  unsigned half_bits_;
};

}  // namespace reeb::io
