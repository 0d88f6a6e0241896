#include "ooc/tables/vertex_column.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace reeb::ooc {

namespace {

bool is_float32(double value) {
  if (!std::isfinite(value)) return true;
  if (std::abs(value) > double{std::numeric_limits<float>::max()}) return false;
  return double{static_cast<float>(value)} == value;
}

}  // namespace

VertexColumn::VertexColumn(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes)
    : temp_(&temp), budget_(&budget), allowance_(allowance_bytes) {
  narrow_.emplace("vertices", temp, budget, allowance_bytes, 0.0f);
}

void VertexColumn::append(std::span<const double> values) {
  if (!wide_ && !std::all_of(values.begin(), values.end(), is_float32)) widen();
  if (wide_) {
    wide_->write(size_, values);
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) narrow_->set(size_ + i, static_cast<float>(values[i]));
  }
  size_ += values.size();
}

void VertexColumn::widen() {
  wide_.emplace("vertices", *temp_, *budget_, allowance_, 0.0);
  std::array<float, 4096> narrow;
  std::array<double, 4096> wide;
  for (std::uint64_t first = 0; first < size_; first += narrow.size()) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(narrow.size(), size_ - first));
    narrow_->read(first, std::span(narrow).first(count));
    std::copy_n(narrow.begin(), count, wide.begin());
    wide_->write(first, std::span<const double>(wide).first(count));
  }
  spilled_before_ = narrow_->pages().spilled_bytes();
  narrow_.reset();
}

}  // namespace reeb::ooc
