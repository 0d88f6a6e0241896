// Positions along a Hilbert curve through the unit cube, on a grid of 2^21 cells per side.
#pragma once

#include <array>
#include <cstdint>

namespace reeb::ooc {

inline constexpr unsigned kHilbertBits = 21;

// The 21 bits of a number, three places apart.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

// The position of a cell on the curve. Successive cells share a face. Each coordinate is below 2^21. (After Skilling,
// Programming the Hilbert curve, 2004: the coordinates become the bits of the position, transposed.) Without branches,
// since they could not be predicted.
inline std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  for (unsigned bit = kHilbertBits - 1; bit > 0; --bit) {
    const std::uint32_t low = (1u << bit) - 1;
    for (std::uint32_t& c : x) {
      const std::uint32_t flipped = low & (0u - (c >> bit & 1u));
      const std::uint32_t swapped = (x[0] ^ c) & (low ^ flipped);
      x[0] ^= flipped | swapped;
      c ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = x[2] >> 1;  // then bit i is the parity of all bits of x[2] above i
  for (const unsigned by : {1u, 2u, 4u, 8u, 16u}) flip ^= flip >> by;
  return spread_bits(x[0] ^ flip) << 2 | spread_bits(x[1] ^ flip) << 1 | spread_bits(x[2] ^ flip);
}

}  // namespace reeb::ooc
