// The Fiedler vector of a mesh: the eigenvector of its graph Laplacian to the smallest eigenvalue
// above zero. Triangles sorted by it make a front that is short everywhere (Isenburg and
// Lindstrom, Streaming Meshes, 2005, spectral sequencing).
#pragma once

#include "libreeb/port/indexed_mesh.h"
#include "ooc/tables/paged_table.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

using VertexNumbers = PagedTable<double>;

// One value a vertex of `mesh`, whose vertices must be numbered along a space-filling curve.
//
// HOW IT SCALES: up to 200,000 vertices (fewer if the budget is small) every vertex is a row of the
// matrix, and the vector is that of the mesh. A larger mesh is coarsened: stretches of equally many
// consecutive vertices become 50,000 clusters, joined by as many edges as the mesh has between
// them; the vector of that weighted graph is found, and spread over the vertices by a few Jacobi
// steps. Time is that of one sparse factorization of at most 200,000 rows, plus three readings of
// the triangles for each step, linear in the mesh.
// Components are chained by weak edges, so that they follow each other.
// MEMORY: about 1 KiB a row, reserved; three shares for tables of vertices.
VertexNumbers fiedler_vector(IndexedMesh& mesh, Workspace& space);

}  // namespace reeb::ooc
