// Random small complexes of every kind that is allowed as input (docs/SEMANTICS.md, Input): surfaces, orientable or
// not, with and without holes; non-manifold edges and vertices; simplices up to dimension 5; loose edges and vertices;
// degenerate and repeated simplices; several components. Functions on them have distinct values, ties of all kinds,
// signed zeros, denormals, or values near the largest.
#pragma once

#include <cstdint>

#include "tests/support/inputs/complex.h"

namespace reeb::test {

// The complex of this number; the same on every machine. Mostly up to 20 vertices, sometimes none, sometimes a few
// hundred.
Complex random_complex(std::uint64_t seed);

// Gives the complex new values; the seed chooses their kind and the values.
void set_random_values(Complex& complex, std::uint64_t seed);

}  // namespace reeb::test
