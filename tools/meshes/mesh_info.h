// `reeb info MESH`: what is known about a mesh before anything is computed from it.
#pragma once

#include <cstdint>
#include <string>

#include "io/formats/open_mesh.h"

namespace reeb::tools {

// Reads the mesh once, and the triangles of a mesh without finalization twice. The live front is the largest number of
// vertices that were introduced (in a stream without finalization: used) and will be used again. It is measured in a
// stream that finalizes its vertices; else it is the front that exact finalization would give in this order.
// `format` as in open_mesh().
// MEMORY: tables of 8 and 4 bytes per vertex, paged to disk within `memory_bytes`.
void print_mesh_info(const std::string& path, const std::string& format, std::uint64_t memory_bytes,
                     const std::string& temp_folder, bool json, const io::ImageOptions& image);

}  // namespace reeb::tools
