// A grid of values in memory, as a file would deliver it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/port/grid_reader.h"
#include "tests/support/inputs/grid_complex.h"

namespace reeb::test {

class MemoryGrid : public GridReader {
 public:
  // `values` has the components of a vertex next to each other.
  MemoryGrid(const GridShape& shape, std::vector<double> values, unsigned components = 1) : values_(std::move(values)) {
    info_.format = "grid in memory";
    info_.axes = shape[2] == 1 ? 2 : 3;
    info_.size = shape;
    info_.components = components;
  }

  GridInfo& change_info() { return info_; }
  const GridInfo& info() const override { return info_; }
  std::size_t read(std::span<double> values) override {
    const std::size_t count = std::min(values.size(), values_.size() - at_);
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(at_), count, values.begin());
    at_ += count;
    return count / info_.components;
  }
  void rewind() override { at_ = 0; }
  GridPlace place_of(std::uint64_t vertex) const override { return {"memory", std::to_string(8 * vertex)}; }
  std::uint64_t bytes_read() const override { return 8 * at_; }

 private:
  GridInfo info_;
  std::vector<double> values_;
  std::size_t at_ = 0;
};

}  // namespace reeb::test
