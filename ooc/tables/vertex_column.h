// One number per vertex, in four bytes if that loses nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "ooc/tables/paged_table.h"

namespace reeb::ooc {

// A column that starts as float32 and changes to float64 at the first value that is not exactly a float32. Values are
// read exactly as written.
//
// THROWS, MEMORY, THREADS: as PagedTable; during the change, both tables are within the allowance.
class VertexColumn {
 public:
  VertexColumn(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes);

  // Appends the next values.
  void append(std::span<const double> values);
  double get(std::uint64_t index) { return wide_ ? wide_->get(index) : double{narrow_->get(index)}; }

  std::uint64_t size() const { return size_; }
  std::uint64_t spilled_bytes() const { return spilled_before_ + pages().spilled_bytes(); }

 private:
  const PageCache& pages() const { return wide_ ? wide_->pages() : narrow_->pages(); }
  void widen();

  const io::TempDir* temp_;
  MemoryBudget* budget_;
  std::uint64_t allowance_;
  std::optional<PagedTable<float>> narrow_;
  std::optional<PagedTable<double>> wide_;
  std::uint64_t size_ = 0, spilled_before_ = 0;
};

}  // namespace reeb::ooc
