// Writes meshes: what any reader delivers goes into any format.
//
// Formats: binary little-endian PLY, OBJ, OFF (nOFF where a vertex has other than 3 coordinates),
// and the streaming meshes SMA, SMB, SMC (version 3), SVA and SVB, as well as lists of events.
// Every simplex is written as triangles: a tetrahedron as its four faces (but in volume meshes, SVA
// and SVB), an edge as a triangle with a repeated corner, so that nothing is lost that matters to a
// Reeb graph. Only streaming meshes hold finalizations.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// The format is told by the suffix of `path`: .ply .obj .off .sma .smb .smc .sva .svb .events.txt.
// THROWS: Error{kUsage} for another suffix; else as AtomicFile.
std::unique_ptr<MeshWriter> create_mesh(const std::string& path, const MeshWriterOptions& options = {});

}  // namespace reeb::io
