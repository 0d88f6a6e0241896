// XXH64: guards blocks of files against damage, not against intent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb::ooc {

std::uint64_t xxh64(std::span<const std::byte> bytes, std::uint64_t seed = 0) noexcept;

}  // namespace reeb::ooc
