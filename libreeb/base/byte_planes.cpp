#include "libreeb/base/byte_planes.h"

#include <algorithm>
#include <bit>
#include <cstring>

// The loops are written out byte by byte. So the compiler sees interleaved bytes and shuffles many at once: half a
// nanosecond per number, where shifting takes two to four.

namespace reeb {

static_assert(std::endian::native == std::endian::little, "planes are the bytes of numbers as they lie in memory");

namespace {

// split() works on tiles of fixed size, in which the compiler knows that planes do not overlap.
constexpr std::size_t kNumbersPerTile = 64;
using Tile = std::array<std::array<std::byte, kNumbersPerTile>, kBytePlanes>;

void split(const std::array<std::uint64_t, kNumbersPerTile>& numbers, Tile& planes) {
  const std::byte* from = std::as_bytes(std::span(numbers)).data();
  for (std::size_t i = 0; i < kNumbersPerTile; ++i) {
    planes[0][i] = from[8 * i];
    planes[1][i] = from[8 * i + 1];
    planes[2][i] = from[8 * i + 2];
    planes[3][i] = from[8 * i + 3];
    planes[4][i] = from[8 * i + 4];
    planes[5][i] = from[8 * i + 5];
    planes[6][i] = from[8 * i + 6];
    planes[7][i] = from[8 * i + 7];
  }
}

}  // namespace

void split_planes(std::span<const std::uint64_t> numbers, std::byte* planes) {
  const std::size_t count = numbers.size();
  std::array<std::uint64_t, kNumbersPerTile> numbers_of_tile{};
  Tile tile;
  for (std::size_t begin = 0; begin < count; begin += kNumbersPerTile) {
    const std::size_t size = std::min(kNumbersPerTile, count - begin);
    std::ranges::copy(numbers.subspan(begin, size), numbers_of_tile.begin());
    split(numbers_of_tile, tile);
    for (std::size_t p = 0; p < kBytePlanes; ++p) std::memcpy(planes + p * count + begin, tile[p].data(), size);
  }
}

void join_planes(const std::array<const std::byte*, kBytePlanes>& planes, std::span<std::uint64_t> numbers) {
  const auto [p0, p1, p2, p3, p4, p5, p6, p7] = planes;
  std::byte* __restrict to = std::as_writable_bytes(numbers).data();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    to[8 * i] = p0[i];
    to[8 * i + 1] = p1[i];
    to[8 * i + 2] = p2[i];
    to[8 * i + 3] = p3[i];
    to[8 * i + 4] = p4[i];
    to[8 * i + 5] = p5[i];
    to[8 * i + 6] = p6[i];
    to[8 * i + 7] = p7[i];
  }
}

}  // namespace reeb
