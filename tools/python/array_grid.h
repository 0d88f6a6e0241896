// An array of a caller as a regular grid of values: nothing is copied, whatever its type and layout are.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "io/mesh/scalar_bytes.h"
#include "libreeb/port/grid_reader.h"

namespace reeb::python {

// Sizes and strides are those of the axes i, j and k (libreeb/port/grid_reader.h).
struct ArrayGrid {
  const char* data = nullptr;
  io::ScalarType type = io::ScalarType::kFloat64;
  std::array<std::int64_t, 3> stride{};  // in bytes; of either sign
  GridInfo info;                         // one component
};

// The array must not change as long as the reader exists. Messages name a value by the array and its indices.
std::unique_ptr<GridReader> read_grid(const ArrayGrid& grid);

}  // namespace reeb::python
