// Closed paths on a closed surface that are independent of those that are known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/defects/odd_cycle.h"
#include "libreeb/defects/surface_patch.h"

namespace reeb {

// Whether each edge has two triangles, oriented alike.
bool is_closed_surface(const SurfacePatch& patch);

// The shortest system of loops through a vertex: 2g closed simple paths, for genus g, that together cut the surface to
// a disc. A way to the vertex that two ends of a loop share is left out of it. Source: Erickson and Whittlesey, Greedy
// optimal homotopy and homology generators (2005). O(n log n).
// REQUIRES: a closed, connected surface.
std::vector<ClosedPath> loop_system(const SurfacePatch& patch, std::uint32_t root);

// Up to `most` closed paths, each the first in loop systems through `roots` vertices, by length, that crosses none of
// `known` and of the ones before it an odd number of times, and bounds nothing together with them. So the surface can
// be cut along all of them.
// REQUIRES: as loop_system().
std::vector<ClosedPath> further_loops(const SurfacePatch& patch, std::span<const ClosedPath> known, std::size_t most,
                                      std::uint32_t roots);

}  // namespace reeb
