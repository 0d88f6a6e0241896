// Columns of 64-bit numbers as byte planes: the content of blocks of nodes and arcs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace reeb::ooc {

// The zstd level of temporary segments; bench/ooc_bench.cpp compares levels.
inline constexpr int kSegmentLevel = -5;

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
  // Appends the packed columns to `packed` and clears the encoder. Bytes of any kind may follow in `packed`.
  void pack(std::vector<std::byte>& packed, int level = kSegmentLevel);

 private:
  void add_planes();

  std::vector<std::uint64_t> column_;
  // For each column: a byte whose bit i says whether plane i is present; then the planes: all lowest bytes, all second
  // ones, and so on. Planes of zeros only are left out.
  std::vector<std::byte> bytes_;
};

class ColumnDecoder {
 public:
  // ok() is false if `packed` does not start with `columns` columns of `count` numbers.
  ColumnDecoder(std::span<const std::byte> packed, std::size_t columns, std::size_t count);
  bool ok() const { return ok_; }
  // The numbers of a column, valid until the next call. REQUIRES: ok().
  std::span<const std::uint64_t> column(std::size_t column);
  // The bytes of `packed` after the columns. REQUIRES: ok().
  std::span<const std::byte> tail() const { return tail_; }

 private:
  bool find_columns();

  std::vector<std::uint64_t> column_;
  std::vector<std::byte> zeros_;  // a plane that was left out
  std::unique_ptr<std::byte[]> memory_;
  std::span<std::byte> bytes_;
  std::vector<std::size_t> begin_;  // by column
  std::span<const std::byte> tail_;
  bool ok_ = false;
};

}  // namespace reeb::ooc
