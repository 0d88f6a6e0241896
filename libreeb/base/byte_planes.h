// Numbers of 32 or 64 bits as byte planes: all lowest bytes, all second ones, and so on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb {

// Of 64-bit numbers; 32-bit ones have half of them.
inline constexpr std::size_t kBytePlanes = 8;

// Writes all planes, one after the other.
// REQUIRES: `planes` has room for the bytes of `numbers` and does not overlap them.
void split_planes(std::span<const std::uint64_t> numbers, std::byte* planes);
void split_planes(std::span<const std::uint32_t> numbers, std::byte* planes);

// The inverse; the planes need not be contiguous.
// REQUIRES: each plane has numbers.size() bytes and does not overlap `numbers`. Planes may share memory.
void join_planes(const std::array<const std::byte*, kBytePlanes>& planes, std::span<std::uint64_t> numbers);
void join_planes(const std::array<const std::byte*, kBytePlanes / 2>& planes, std::span<std::uint32_t> numbers);

}  // namespace reeb
