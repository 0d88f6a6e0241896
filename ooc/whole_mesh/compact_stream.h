// Writes an indexed mesh as a compact pre-order stream with exact finalization.
#pragma once

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_writer.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

// Writes the triangles in the order in which `mesh` delivers them. A vertex comes directly before the first triangle
// that names it and is finalized directly after the last one, so that the front is as short as this order allows.
// Vertices are renumbered in this order; those that no triangle names come last. The first `dimension` columns are
// coordinates, the others properties.
//
// `exact`: one batch per triangle, for formats that store finalization; else large batches without it. The writer is
// not closed. Reads the triangles twice. Takes 16 bytes per vertex, paged in three shares, since an order across that
// of the vertices touches many pages at a time.
void write_compact(IndexedMesh& mesh, unsigned dimension, bool exact, MeshWriter& writer, Workspace& space);

}  // namespace reeb::ooc
