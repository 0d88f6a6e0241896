// Random small complexes of every kind that the input may have (DESIGN.md 1.1): surfaces,
// orientable or not, with and without holes; non-manifold edges and vertices; simplices up to
// dimension 5; loose edges and vertices; degenerate and repeated simplices; several parts; and
// functions on them with distinct values, ties of all sorts, signed zeros, denormals and values
// near the largest.
#pragma once

#include <cstdint>

#include "tests/support/complex.h"

namespace reeb::test {

// The complex of this number; the same on every machine. Mostly up to 20 vertices, at times none,
// now and then a few hundred.
Complex random_complex(std::uint64_t seed);

// Gives the complex new values, of the kind and with the numbers that the seed chooses.
void set_random_values(Complex& complex, std::uint64_t seed);

}  // namespace reeb::test
