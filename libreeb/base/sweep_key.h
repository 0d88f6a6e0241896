// The total order of vertices, which decides every tie (docs/SEMANTICS.md, Order).
#pragma once

#include <bit>
#include <cstdint>

#include "libreeb/base/ids.h"

namespace reeb {

// A vertex as the sweep sees it. The value is finite, and -0.0 was made 0.0 when it was read.
struct SweepKey {
  double value = 0;
  VertexId vertex;

  friend bool operator==(const SweepKey&, const SweepKey&) = default;
};

// Strict total order: by value, ties by index. It does no arithmetic, so the answer is exact. It depends on its
// arguments only, not on chunks, threads or stream order.
// REQUIRES: neither value is NaN (readers refuse NaN).
inline bool operator<(const SweepKey& a, const SweepKey& b) noexcept {
  return a.value < b.value || (a.value == b.value && a.vertex < b.vertex);
}

// The value's bits, mapped such that the results compare as unsigned numbers the way the values do.
// REQUIRES: not NaN, not -0.0.
inline std::uint64_t ordered_bits(double value) noexcept {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return bits ^ ((bits >> 63) != 0 ? ~std::uint64_t{0} : std::uint64_t{1} << 63);
}

// The inverse of ordered_bits.
inline double from_ordered_bits(std::uint64_t bits) noexcept {
  return std::bit_cast<double>(bits ^ ((bits >> 63) != 0 ? std::uint64_t{1} << 63 : ~std::uint64_t{0}));
}

}  // namespace reeb
