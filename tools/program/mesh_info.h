// `reeb info MESH`: what there is to know of a mesh before anything is computed of it.
#pragma once

#include <cstdint>
#include <string>

namespace reeb::tools {

// Reads the mesh once, and the triangles of one without finalization once more.
// The live front is the largest number of vertices that were introduced (in a stream without
// finalization: used) and will be used again: measured in a stream that finalizes its vertices,
// else what exact finalization would give in this order.
// MEMORY: tables of 8 and 4 bytes a vertex, paged to disk within `memory_bytes`.
void print_mesh_info(const std::string& path, std::uint64_t memory_bytes, const std::string& temp_folder, bool json);

}  // namespace reeb::tools
