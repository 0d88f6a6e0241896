// Writes meshes as VTK XML files: .vtu with points, edges, triangles and tetrahedra, .vtp without tetrahedra.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// All numbers are text. The properties become point data: Float64, those of MeshWriterOptions::integer_properties
// Int64. Cells are grouped by dimension, in the order of the mesh; a simplex that the format does not have is written
// as its triangles. Of the coordinates, the first three are kept. MEMORY: a few MiB; what comes after the points waits
// in files without a name. THROWS: Error{kUsage} for another suffix; else as AtomicFile.
std::unique_ptr<MeshWriter> create_vtk_mesh(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
