#include "io/images/voxel_type.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "io/mesh/scalar_bytes.h"

namespace reeb::io {
namespace {

constexpr std::array<std::string_view, 10> kNames = {"i8",  "u8",  "i16", "u16", "i32",
                                                     "u32", "i64", "u64", "f32", "f64"};

template <class Use>
auto with_voxel(VoxelType type, const Use& use) {
  switch (type) {
    case VoxelType::kInt8:
      return use(std::int8_t{});
    case VoxelType::kUint8:
      return use(std::uint8_t{});
    case VoxelType::kInt16:
      return use(std::int16_t{});
    case VoxelType::kUint16:
      return use(std::uint16_t{});
    case VoxelType::kInt32:
      return use(std::int32_t{});
    case VoxelType::kUint32:
      return use(std::uint32_t{});
    case VoxelType::kInt64:
      return use(std::int64_t{});
    case VoxelType::kUint64:
      return use(std::uint64_t{});
    case VoxelType::kFloat32:
      return use(float{});
    case VoxelType::kFloat64:
      break;
  }
  return use(double{});
}

// Whether more than 53 binary digits are left of an integer without its last zeros.
template <class Integer>
bool is_rounded(Integer value) {
  std::uint64_t size = static_cast<std::uint64_t>(value);
  if (value < Integer{0}) size = ~size + 1;
  return size != 0 && (size >> std::countr_zero(size)) >> 53 != 0;
}

}  // namespace

std::size_t byte_size(VoxelType type) {
  return with_voxel(type, [](auto zero) { return sizeof zero; });
}

std::string_view type_name(VoxelType type) { return kNames[static_cast<std::size_t>(type)]; }

std::optional<VoxelType> type_named(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<VoxelType>(found - kNames.begin());
}

std::uint64_t to_doubles(VoxelType type, bool big_endian, const char* bytes, std::size_t count, double* values) {
  return with_voxel(type, [&](auto zero) {
    using Scalar = decltype(zero);
    std::uint64_t rounded = 0;
    const auto convert = [&](bool swap) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto value = load_scalar<Scalar>(bytes + i * sizeof(Scalar), swap);
        if constexpr (std::is_integral_v<Scalar> && sizeof(Scalar) == 8) rounded += is_rounded(value) ? 1u : 0u;
        values[i] = static_cast<double>(value) + 0.0;
      }
    };
    // Two loops, each without a test inside.
    if (big_endian)
      convert(true);
    else
      convert(false);
    return rounded;
  });
}

}  // namespace reeb::io
