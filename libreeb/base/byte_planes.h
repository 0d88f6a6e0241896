// 64-bit numbers as byte planes: all lowest bytes, all second ones, and so on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb {

inline constexpr std::size_t kBytePlanes = 8;

// Writes all planes, one after the other.
// REQUIRES: `planes` has room for kBytePlanes * numbers.size() bytes and does not overlap `numbers`.
void split_planes(std::span<const std::uint64_t> numbers, std::byte* planes);

// The inverse; the planes need not be contiguous.
// REQUIRES: each plane has numbers.size() bytes and does not overlap `numbers`. Planes may share memory.
void join_planes(const std::array<const std::byte*, kBytePlanes>& planes, std::span<std::uint64_t> numbers);

}  // namespace reeb
