// The Fiedler vector of a mesh: the eigenvector of its graph Laplacian for the smallest eigenvalue above zero.
// Triangles sorted by it have a front that is short everywhere (Isenburg and Lindstrom, Streaming Meshes, 2005,
// spectral sequencing).
#pragma once

#include "libreeb/port/indexed_mesh.h"
#include "ooc/tables/paged_table.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

using VertexNumbers = PagedTable<double>;

// One value per vertex of `mesh`, whose vertices must be numbered along a space-filling curve.
//
// HOW IT SCALES: Up to 200,000 vertices (fewer if the budget is small), every vertex is a row of the matrix, and the
//           vector is that of the mesh. A larger mesh is coarsened: ranges of the same number of consecutive vertices
//           become 50,000 clusters. Two clusters are joined with the number of mesh edges between them as weight. The
//           vector of that weighted graph is computed, and extended to the vertices by a few Jacobi steps. The time is
//           that of one sparse factorization of at most 200,000 rows, plus a reading of the triangles for each of these
//           steps. Components are chained by weak edges, so that they follow each other.
//           Where triangles are in no order, the factors have many more entries than those of a surface. If they do not
//           fit the budget, two clusters become one, repeatedly.
// MEMORY: about 1 KiB per row of a surface; what the factors take is known before they are made. Reserved. Two shares
//           for tables of vertices.
// THROWS: Error{kResource} if not even 64 rows fit.
VertexNumbers fiedler_vector(IndexedMesh& mesh, Workspace& space);

}  // namespace reeb::ooc
