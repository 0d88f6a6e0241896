// Scalars in binary files: any type, either byte order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "io/text/words.h"

namespace reeb::io {

enum class ScalarType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };
inline bool is_float(ScalarType type) { return type >= ScalarType::kFloat32; }

static_assert(std::endian::native == std::endian::little, "byte orders are told against little endian");

template <class T>
T load_scalar(const char* bytes, bool swap) {
  T value;
  if (!swap) {
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  char turned[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) turned[i] = bytes[sizeof(T) - 1 - i];
  std::memcpy(&value, turned, sizeof value);
  return value;
}

// Whether no double has this value: more than 53 binary digits are left of an integer without its last zeros.
template <class Scalar>
bool is_rounded(Scalar value) {
  if constexpr (std::is_integral_v<Scalar> && sizeof(Scalar) == 8) {
    auto size = static_cast<std::uint64_t>(value);
    if (value < Scalar{0}) size = ~size + 1;
    return size != 0 && (size >> std::countr_zero(size)) >> 53 != 0;
  }
  return false;
}

// The same of a word.
inline bool is_rounded_text(std::string_view word) {
  constexpr std::size_t kLeastDigits = 16;
  if (word.size() < kLeastDigits) return false;
  if (const auto value = whole_number<std::int64_t>(word)) return is_rounded(*value);
  const auto large = whole_number<std::uint64_t>(word);
  return large && is_rounded(*large);
}

// What a format calls a type.
struct TypeName {
  std::string_view name;
  ScalarType type;
};

inline std::optional<ScalarType> find_type(std::span<const TypeName> types, std::string_view name) {
  const auto found = std::ranges::find(types, name, &TypeName::name);
  return found == types.end() ? std::nullopt : std::optional(found->type);
}

// Calls `use` with a zero of the C++ type, so that a loop over values is compiled once for each type.
template <class Use>
decltype(auto) with_type(ScalarType type, Use&& use) {
  switch (type) {
    case ScalarType::kInt8:
      return use(std::int8_t{});
    case ScalarType::kUint8:
      return use(std::uint8_t{});
    case ScalarType::kInt16:
      return use(std::int16_t{});
    case ScalarType::kUint16:
      return use(std::uint16_t{});
    case ScalarType::kInt32:
      return use(std::int32_t{});
    case ScalarType::kUint32:
      return use(std::uint32_t{});
    case ScalarType::kInt64:
      return use(std::int64_t{});
    case ScalarType::kUint64:
      return use(std::uint64_t{});
    case ScalarType::kFloat32:
      return use(float{});
    case ScalarType::kFloat64:
      break;
  }
  return use(double{});
}

inline std::size_t byte_size(ScalarType type) {
  return with_type(type, [](auto zero) { return sizeof zero; });
}

// Whether each value of the type is exactly a float32.
inline bool fits_float32(ScalarType type) { return type == ScalarType::kFloat32 || byte_size(type) < 4; }

// is_rounded() of a value in memory.
inline bool is_rounded_at(ScalarType type, const char* bytes, bool swap) {
  return with_type(type, [&](auto none) { return is_rounded(load_scalar<decltype(none)>(bytes, swap)); });
}

// The largest value of an integer type.
inline std::uint64_t largest_value(ScalarType type) {
  return with_type(type,
                   [](auto zero) { return static_cast<std::uint64_t>(std::numeric_limits<decltype(zero)>::max()); });
}

// `zero` is added: 0.0 makes 0.0 of -0.0, and -0.0 changes nothing.
inline double load_double(ScalarType type, const char* bytes, bool swap, double zero = 0.0) {
  return with_type(type,
                   [&](auto none) { return static_cast<double>(load_scalar<decltype(none)>(bytes, swap)) + zero; });
}

// Tests the exponents without branches, since this runs over every value that is read.
inline bool all_finite(std::span<const double> values) {
  constexpr std::uint64_t kExponent = 0x7ff0'0000'0000'0000u;
  std::uint64_t non_finite = 0;
  for (const double value : values)
    non_finite |= (std::bit_cast<std::uint64_t>(value) & kExponent) == kExponent ? 1u : 0u;
  return non_finite == 0;
}

// REQUIRES: an integer type.
inline std::int64_t load_integer(ScalarType type, const char* bytes, bool swap) {
  return with_type(type,
                   [&](auto zero) { return static_cast<std::int64_t>(load_scalar<decltype(zero)>(bytes, swap)); });
}

}  // namespace reeb::io
