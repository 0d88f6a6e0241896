// Writes CX: every simplex as what it is. Vertices have nothing but coordinates; numbers are exact.
#pragma once

#include <memory>
#include <string>

#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

// THROWS: Error{kBadInput} for other than 1 to 9 coordinates; as AtomicFile.
std::unique_ptr<MeshWriter> create_cx(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
