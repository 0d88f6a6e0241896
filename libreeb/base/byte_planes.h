// 64-bit numbers as byte planes: all lowest bytes, all second ones, and so on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb {

inline constexpr std::size_t kBytePlanes = 8;

// Writes all planes, one after the other. REQUIRES: room for kBytePlanes * numbers.size() bytes, elsewhere.
void split_planes(std::span<const std::uint64_t> numbers, std::byte* planes);

// The reverse, of planes that lie anywhere else. REQUIRES: each has numbers.size() bytes; any of them may be the same.
void join_planes(const std::array<const std::byte*, kBytePlanes>& planes, std::span<std::uint64_t> numbers);

}  // namespace reeb
