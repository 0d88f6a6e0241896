// Eigenvectors of the Laplacian of a mesh: smooth functions that follow its shape.
#pragma once

#include <cstdint>
#include <vector>

#include "io/fields/whole_complex.h"

namespace reeb::io {

struct Eigenvector {
  std::vector<double> values;  // of all vertices; 0 on other components
  double eigenvalue = 0;
  double residual = 0;               // |L u - eigenvalue M u| / |eigenvalue M u|, in the norm of the inverse of M
  std::uint64_t other_vertices = 0;  // vertices on other components
};

// The K-th eigenvector (from 1) that is not constant, of the component with most vertices (of several the first), in
// the order of eigenvalues. On surfaces L has cotangent weights, and M is a third of the area of the triangles at a
// vertex; on other complexes L is the Laplacian of the graph of edges, and M the identity. Repeated simplices, and
// edges that triangles have, change nothing. The vector has the length 1 in the norm of M, and its entry of largest
// magnitude is positive. Of eigenvalues that are equal (a sphere has three times the first), each combination is as
// good.
//
// Shift and invert: Spectra's Lanczos method on the inverse of L + epsilon M, factorized by Eigen. What Lanczos may
// miss of multiple eigenvalues is found by runs on the complement of what is known.
//
// If K is near half of the vertices or above, or there are few vertices, Eigen's dense method finds all eigenvectors.
//
// THROWS: Error{kBadInput} if the component has K or fewer vertices, if its triangles have no area, or if the method
// does
//         not converge; Error{kResource} with the memory that it needs, before it is begun.
// TIME, MEMORY: those of a sparse Cholesky factorization: some 25 s and 1.6 GB for a surface of a million vertices. Of
//         the dense method: the cube of the vertices, and 16 bytes times their square.
Eigenvector laplacian_eigenvector(const WholeComplex& complex, std::uint64_t k, MemoryBudget& budget);

}  // namespace reeb::io
