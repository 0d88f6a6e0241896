// Writes meshes: the batches of any reader into any format.
//
// Formats: binary little-endian PLY, OBJ, OFF (nOFF if a vertex does not have 3 coordinates), the streaming meshes SMA,
// SMB, SMC (version 3), SVA and SVB, CX, and lists of events. CX has every simplex as what it is. PLY, OBJ and OFF have
// points, edges and triangles; SVA, SVB and lists of events have tetrahedra. What a format does not have is written as
// triangles: a cell as its triangles, in streaming meshes an edge as a triangle with a repeated corner. This keeps
// everything that the Reeb graph depends on. Only streaming meshes and lists of events store finalizations.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// THROWS: Error{kUsage} if create_mesh() does not know the suffix of `path`.
void check_mesh_name(const std::string& path);
// Whether a format that create_mesh() knows holds tetrahedra as such.
bool has_tetrahedra(const std::string& path);

// The suffix of `path` determines the format: .ply .obj .off .cx .sma .smb .smc .sva .svb .events.txt.
// THROWS: Error{kUsage} for another suffix; else as AtomicFile.
std::unique_ptr<MeshWriter> create_mesh(const std::string& path, const MeshWriterOptions& options = {});

}  // namespace reeb::io
