// Positions along a Hilbert curve through the unit cube, on a grid of 2^21 cells per side.
#pragma once

#include <array>
#include <cstdint>

namespace reeb::ooc {

inline constexpr unsigned kHilbertBits = 21;

// The position of a cell on the curve. Successive cells share a face. Each coordinate is below 2^21. (After Skilling,
// Programming the Hilbert curve, 2004: the coordinates become the bits of the position, transposed.)
inline std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << (kHilbertBits - 1); q > 1; q >>= 1) {
    const std::uint32_t low = q - 1;
    for (std::uint32_t& c : x) {
      if ((c & q) != 0) {
        x[0] ^= low;
      } else {
        const std::uint32_t swapped = (x[0] ^ c) & low;
        x[0] ^= swapped;
        c ^= swapped;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = 1u << (kHilbertBits - 1); q > 1; q >>= 1)
    if ((x[2] & q) != 0) flip ^= q - 1;
  std::uint64_t index = 0;
  for (unsigned bit = kHilbertBits; bit-- > 0;)
    for (const std::uint32_t c : x) index = index << 1 | ((c ^ flip) >> bit & 1u);
  return index;
}

}  // namespace reeb::ooc
