// A closed curve that divides nothing, found on a surface as earlier repairs left it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/repair/editable_patch.h"

namespace reeb {

// A short closed curve along edges through one of these vertices, if there is one up to `most` that does not divide the
// patch; so it divides no surface of which that is a part. Else empty. Of many vertices, a dozen or two are tried.
// TIME: a search within `most` of each.
std::vector<std::uint32_t> nearby_loop(const EditablePatch& patch, std::span<const std::uint32_t> near, double most);

}  // namespace reeb
