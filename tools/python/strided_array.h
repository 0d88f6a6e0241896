// An array of numbers that someone else holds: any type, any distance between its items.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "io/mesh/scalar_bytes.h"

namespace reeb::python {

// Instead of a file, errors about arrays have this and a place like "faces[3, 1]" (reeb/errors.py). No name of an array
// does: it could be that of a file.
inline constexpr const char* kNoFile = "-";
inline std::string place_in(const std::string& array, const std::string& indices) {
  return array + '[' + indices + ']';
}

// Of two axes; an array of one axis has one column. Refers to memory of the caller, in the byte order of the machine.
struct StridedArray {
  const char* data = nullptr;
  io::ScalarType type = io::ScalarType::kFloat64;
  std::array<std::uint64_t, 2> size{0, 1};
  std::array<std::int64_t, 2> stride{};  // in bytes; of either sign

  const char* at(std::uint64_t row, std::uint64_t column) const {
    return data + static_cast<std::int64_t>(row) * stride[0] + static_cast<std::int64_t>(column) * stride[1];
  }

  // How many values of a column have to be rounded to doubles.
  std::uint64_t rounded(std::uint64_t column) const {
    if (type != io::ScalarType::kInt64 && type != io::ScalarType::kUint64) return 0;
    return io::with_type(type, [&](auto zero) {
      std::uint64_t count = 0;
      for (std::uint64_t row = 0; row < size[0]; ++row)
        count += io::is_rounded(io::load_scalar<decltype(zero)>(at(row, column), false)) ? 1u : 0u;
      return count;
    });
  }
};

}  // namespace reeb::python
