// Writes an indexed mesh as a compact pre-order stream with exact finalization.
#pragma once

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_writer.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

// The triangles in the order in which `mesh` delivers them. A vertex comes directly before the
// first triangle that names it and is final directly after the last one, so that the front is as
// short as this order allows; vertices are numbered anew as they come. Those that no triangle names
// come last. The first `dimension` columns are coordinates, the others properties.
//
// `exact`: a batch a triangle, for formats that hold finalization; else large batches without it.
// The writer is not closed. Two readings of the triangles; 16 bytes a vertex, paged in
// three shares, since an order across that of the vertices touches many pages at a time.
void write_compact(IndexedMesh& mesh, unsigned dimension, bool exact, MeshWriter& writer, Workspace& space);

}  // namespace reeb::ooc
