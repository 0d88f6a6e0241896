// Whether a closed curve on a surface bounds together with others: whether it adds a class of its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/defects/odd_cycle.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb {

// Whether the curve, alone or together with some of the others, is the boundary of triangles of the patch (modulo 2).
// What touches the rim or a boundary counts as part of no such set of triangles. A curve is a closed path along edges,
// given by these edges.
// TIME: O(n) for n triangles, and elimination on the parts into which the curves cut the patch.
bool bounds_with(const SurfacePatch& patch, std::span<const std::uint32_t> curve,
                 std::span<const std::vector<std::uint32_t>> others);

// The edges of a closed path, in its order.
std::vector<std::uint32_t> edges_of(const SurfacePatch& patch, const ClosedPath& path);

// Whether the path crosses one of the others an odd number of times, or bounds something together with them. If so, the
// surface cannot be cut along all of them without dividing it.
// REQUIRES: the paths are simple, and their vertices are whole.
bool depends_on(const SurfacePatch& patch, const ClosedPath& path, std::span<const ClosedPath> others);

}  // namespace reeb
