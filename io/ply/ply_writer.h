// Writes binary little-endian PLY: float or double vertex columns, faces as uchar + three 32-bit indices.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// THROWS: as create_mesh().
std::unique_ptr<MeshWriter> create_ply(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
