// The types of the values of an image, and how their bytes become numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/mesh/scalar_bytes.h"

namespace reeb::io {

// The name without a byte order: "u8", "i16", "f32".
std::string_view type_name(ScalarType type);
std::optional<ScalarType> type_named(std::string_view name);

// values[i] is the i-th of the numbers at `bytes`; -0.0 becomes 0.0. Returns how many of them had to be rounded: those
// that are integers beyond 2^53 and no double.
std::uint64_t to_doubles(ScalarType type, bool big_endian, const char* bytes, std::size_t count, double* values);

}  // namespace reeb::io
