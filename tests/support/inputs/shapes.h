// Shapes of any size whose topology is known. Unless a comment says otherwise, all values are 0, positions draw the
// shape if it can be drawn, and simplices come in row order.
#pragma once

#include <cstdint>

#include "tests/support/inputs/complex.h"

namespace reeb::test {

// How the sides of a rectangle are glued.
enum class Gluing { kDisc, kCylinder, kMoebius, kTorus, kKlein, kProjective, kSphere };
inline constexpr unsigned kGluings = 7;

// A rectangle of columns x rows cells, two triangles each, with its sides glued. With 3 x 3 cells or more (kProjective:
// 4 x 4) it is a surface; smaller ones have degenerate and repeated triangles.
Complex glued_grid(std::size_t columns, std::size_t rows, Gluing gluing);

// An upright torus (its hole is seen from the side), value = height, slightly tilted so that no
// two values are equal. REQUIRES: rings, sides >= 3.
Complex upright_torus(std::size_t rings, std::size_t sides);

// The connected sum of `genus` tori; a sphere for 0.
Complex closed_surface(unsigned genus, std::size_t columns, std::size_t rows);

// `blades` triangles around vertex 0; closed: the last shares an edge with the first.
Complex fan(std::size_t blades, bool closed);

// `pages` triangles at the edge (0, 1).
Complex book(std::size_t pages);

// A disc in row order with all values equal.
Complex plateau(std::size_t columns, std::size_t rows);

// A disc in row order whose value is the row: a sweep along the stream with ties.
Complex tied_strip(std::size_t columns, std::size_t rows);

// Both complexes, one after the other, not connected.
Complex disjoint_union(const Complex& first, const Complex& second);

}  // namespace reeb::test
