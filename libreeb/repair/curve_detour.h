// A closed curve on a surface that was changed since it was found.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/repair/editable_patch.h"

namespace reeb {

// The curve itself as far as its edges are there; the shortest ways between what is left of it elsewhere. Empty if that
// is more than half as long again, or not simple. Whether it still divides nothing must be tested.
std::vector<std::uint32_t> with_detours(const EditablePatch& patch, std::span<const std::uint32_t> curve);

}  // namespace reeb
