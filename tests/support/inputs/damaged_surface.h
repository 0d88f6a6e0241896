// Surfaces with all that can be wrong with one: boundaries, non-manifold edges and vertices, degenerate, duplicate,
// turned and folded triangles, loose edges and vertices; some without anything wrong.
#pragma once

#include <cstdint>

#include "tests/support/inputs/complex.h"

namespace reeb::test {

// The surface of this number; the same on every machine. Up to a few hundred triangles. Without listed edges and points
// if `triangles_only`.
Complex damaged_surface(std::uint64_t seed, bool triangles_only);

}  // namespace reeb::test
