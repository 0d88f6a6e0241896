// Writes OFF, or nOFF if a vertex does not have three coordinates.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// THROWS: as create_mesh().
std::unique_ptr<MeshWriter> create_off(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
