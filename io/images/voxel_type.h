// The types of the values of an image, and how their bytes become numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace reeb::io {

enum class VoxelType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

std::size_t byte_size(VoxelType type);
// Whether not every value is exactly a double.
inline bool is_wide(VoxelType type) { return type == VoxelType::kInt64 || type == VoxelType::kUint64; }

// The name without a byte order: "u8", "i16", "f32".
std::string_view type_name(VoxelType type);
std::optional<VoxelType> type_named(std::string_view name);

// values[i] is the i-th of the numbers at `bytes`; -0.0 becomes 0.0. Returns how many of them had to be rounded: those
// that are integers beyond 2^53 and no double.
std::uint64_t to_doubles(VoxelType type, bool big_endian, const char* bytes, std::size_t count, double* values);

}  // namespace reeb::io
