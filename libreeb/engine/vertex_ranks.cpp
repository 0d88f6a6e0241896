#include "libreeb/engine/vertex_ranks.h"

#include <algorithm>
#include <array>

#include "libreeb/base/sweep_key.h"

namespace reeb {
namespace {

constexpr unsigned kDigitBits = 11;
constexpr unsigned kDigits = 6;  // 66 bits cover 64
constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
constexpr std::size_t kRadixMinimum = 512;  // below, comparing is faster

std::size_t digit_of(std::uint64_t bits, unsigned digit) {
  return static_cast<std::size_t>(bits >> (digit * kDigitBits)) & (kBuckets - 1);
}

}  // namespace

void VertexRanks::sort(std::span<const double> values, std::span<const VertexId> ids) {
  const std::size_t n = values.size();
  entries_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    entries_[i] = {ordered_bits(values[i]), static_cast<std::uint32_t>(i)};

  if (n < kRadixMinimum) {
    std::sort(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) {
      return a.bits != b.bits ? a.bits < b.bits : ids[a.local] < ids[b.local];
    });
  } else {
    std::array<std::array<std::uint32_t, kBuckets>, kDigits> counts{};
    for (const Entry& e : entries_)
      for (unsigned d = 0; d < kDigits; ++d) ++counts[d][digit_of(e.bits, d)];
    other_.resize(n);
    for (unsigned d = 0; d < kDigits; ++d) {
      auto& count = counts[d];
      if (count[digit_of(entries_[0].bits, d)] == n) continue;
      std::uint32_t sum = 0;
      for (std::uint32_t& c : count) sum += std::exchange(c, sum);
      for (const Entry& e : entries_) other_[count[digit_of(e.bits, d)]++] = e;
      entries_.swap(other_);
    }
    for (std::size_t first = 0; first < n;) {
      std::size_t last = first + 1;
      while (last < n && entries_[last].bits == entries_[first].bits) ++last;
      if (last - first > 1)
        std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(first),
                  entries_.begin() + static_cast<std::ptrdiff_t>(last),
                  [&](const Entry& a, const Entry& b) { return ids[a.local] < ids[b.local]; });
      first = last;
    }
  }

  order_.resize(n);
  for (std::size_t r = 0; r < n; ++r) order_[r] = entries_[r].local;
}

}  // namespace reeb
