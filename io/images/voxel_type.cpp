#include "io/images/voxel_type.h"

#include <algorithm>
#include <array>

namespace reeb::io {
namespace {

constexpr std::array<std::string_view, 10> kNames = {"i8",  "u8",  "i16", "u16", "i32",
                                                     "u32", "i64", "u64", "f32", "f64"};

}  // namespace

std::string_view type_name(ScalarType type) { return kNames[static_cast<std::size_t>(type)]; }

std::optional<ScalarType> type_named(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<ScalarType>(found - kNames.begin());
}

std::uint64_t to_doubles(ScalarType type, bool big_endian, const char* bytes, std::size_t count, double* values) {
  return with_type(type, [&](auto zero) {
    using Scalar = decltype(zero);
    std::uint64_t rounded = 0;
    const auto convert = [&](bool swap) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto value = load_scalar<Scalar>(bytes + i * sizeof(Scalar), swap);
        rounded += is_rounded(value) ? 1u : 0u;
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
