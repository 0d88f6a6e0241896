// The writers behind create_mesh(), one a format.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

std::unique_ptr<MeshWriter> create_ply(const std::string& path, const MeshWriterOptions& options);
std::unique_ptr<MeshWriter> create_obj(const std::string& path, const MeshWriterOptions& options);
std::unique_ptr<MeshWriter> create_off(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
