// Columns of 64-bit numbers as byte planes: what blocks of nodes and arcs are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace reeb::ooc {

// zstd level of temporary segments; bench/ooc_bench.cpp compares levels.
inline constexpr int kSegmentLevel = -1;

// Gathers the columns of one block, all of one length, and packs them together.
class ColumnEncoder {
 public:
  // The column holds code(0), code(1), ..., code(count - 1).
  template <class Code>
  void add(std::size_t count, const Code& code) {
    column_.resize(count);
    for (std::size_t i = 0; i < count; ++i) column_[i] = code(i);
    add_planes();
  }
  // Appends them to `packed`, which may go on with bytes of any kind, and begins anew.
  void pack(std::vector<std::byte>& packed, int level = kSegmentLevel);

 private:
  void add_planes();

  std::vector<std::uint64_t> column_;
  // Of each column a byte whose bit i says that there is a plane i; then the planes: all lowest bytes,
  // all second ones, and so on. Planes of nothing but zeros are left out.
  std::vector<std::byte> bytes_;
};

class ColumnDecoder {
 public:
  // ok() is false if `packed` does not begin with `columns` columns of `count` numbers.
  ColumnDecoder(std::span<const std::byte> packed, std::size_t columns, std::size_t count);
  bool ok() const { return ok_; }
  // The numbers of a column, until the next call. REQUIRES: ok().
  std::span<const std::uint64_t> column(std::size_t column);
  // What comes after the columns in `packed`. REQUIRES: ok().
  std::span<const std::byte> tail() const { return tail_; }

 private:
  bool find_columns();

  std::vector<std::uint64_t> column_;
  std::vector<std::byte> zeros_;  // a plane that was left out
  std::unique_ptr<std::byte[]> memory_;
  std::span<std::byte> bytes_;
  std::vector<std::size_t> begin_;  // of each column
  std::span<const std::byte> tail_;
  bool ok_ = false;
};

}  // namespace reeb::ooc
