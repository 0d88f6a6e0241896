// Columns of 64-bit numbers as byte planes: what blocks of nodes and arcs are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace reeb::ooc {

// zstd level of temporary segments; bench/ooc_bench.cpp compares levels.
inline constexpr int kSegmentLevel = 1;

// Small numbers of either sign as small numbers without sign.
inline std::uint64_t zigzag(std::uint64_t difference) {
  return difference << 1 ^ (0 - (difference >> 63));
}
inline std::uint64_t unzigzag(std::uint64_t code) { return code >> 1 ^ (0 - (code & 1)); }

// Gathers the columns of one block, all of one length, and packs them together.
class ColumnEncoder {
 public:
  // The column holds code(0), code(1), ..., code(count - 1).
  template <class Code>
  void add(std::size_t count, const Code& code) {
    const std::size_t before = planes_.size();
    planes_.resize(before + 8 * count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t value = code(i);
      for (std::size_t b = 0; b < 8; ++b)
        planes_[before + b * count + i] = static_cast<std::byte>(value >> (8 * b));
    }
  }
  void pack(std::vector<std::byte>& packed, int level = kSegmentLevel) const;

 private:
  std::vector<std::byte> planes_;
};

class ColumnDecoder {
 public:
  // ok() is false if `packed` is not `columns` columns of `count` numbers.
  ColumnDecoder(std::span<const std::byte> packed, std::size_t columns, std::size_t count);
  bool ok() const { return ok_; }
  // The i-th number of a column. REQUIRES: ok().
  std::uint64_t at(std::size_t column, std::size_t i) const {
    std::uint64_t value = 0;
    for (std::size_t b = 0; b < 8; ++b)
      value |= std::to_integer<std::uint64_t>(planes_[(8 * column + b) * count_ + i]) << (8 * b);
    return value;
  }

 private:
  std::vector<std::byte> planes_;
  std::size_t count_;
  bool ok_;
};

}  // namespace reeb::ooc
