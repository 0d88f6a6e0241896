// Writes OBJ: `v` and `f` lines in the order of arrival, three coordinates per vertex.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// THROWS: as create_mesh().
std::unique_ptr<MeshWriter> create_obj(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
