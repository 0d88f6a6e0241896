// The one hash of the project.
#pragma once

#include <cstdint>

namespace reeb {

// One step of SplitMix64: a bijection of the 64-bit numbers that looks random. The values of random functions and the
// generated meshes depend on it, so it must never change.
constexpr std::uint64_t mix(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace reeb
