// Positions along a Hilbert curve through the unit cube, on a grid of 2^21 cells per side.
#pragma once

#include <array>
#include <cstddef>
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

// The positions of cells on the curve; x[axis][i] is a coordinate of cell i, below 2^21. Successive cells share a face.
// (After Skilling, Programming the Hilbert curve, 2004: the coordinates become the bits of the position, transposed.)
// Without branches, since they could not be predicted. Dozens of cells at a time take a quarter of the time a cell,
// since compilers use vector instructions for them.
template <std::size_t kCells>
std::array<std::uint64_t, kCells> hilbert_indices(std::array<std::array<std::uint32_t, kCells>, 3> x) {
  for (unsigned bit = kHilbertBits - 1; bit > 0; --bit) {
    const std::uint32_t low = (1u << bit) - 1;
    for (std::size_t i = 0; i < kCells; ++i) {
      std::uint32_t first = x[0][i];
      first ^= low & (0u - (first >> bit & 1u));
      for (std::size_t axis = 1; axis < 3; ++axis) {
        const std::uint32_t other = x[axis][i];
        const std::uint32_t flipped = low & (0u - (other >> bit & 1u));
        const std::uint32_t swapped = (first ^ other) & (low ^ flipped);
        first ^= flipped | swapped;
        x[axis][i] = other ^ swapped;
      }
      x[0][i] = first;
    }
  }
  std::array<std::uint64_t, kCells> indices;
  for (std::size_t i = 0; i < kCells; ++i) {
    const std::uint32_t second = x[1][i] ^ x[0][i], third = x[2][i] ^ second;
    std::uint32_t flip = third >> 1;  // then bit i is the parity of all bits of `third` above i
    for (const unsigned by : {1u, 2u, 4u, 8u, 16u}) flip ^= flip >> by;
    indices[i] = spread_bits(x[0][i] ^ flip) << 2 | spread_bits(second ^ flip) << 1 | spread_bits(third ^ flip);
  }
  return indices;
}

inline std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& x) {
  return hilbert_indices<1>({{{x[0]}, {x[1]}, {x[2]}}})[0];
}

}  // namespace reeb::ooc
