// Whether a `.reeb` file can be of a mesh, by the counts in its header.
#pragma once

#include <cstdint>
#include <string>

namespace reeb {

struct MeshCounts {
  std::uint64_t vertices = 0, triangles = 0;
  friend bool operator==(const MeshCounts&, const MeshCounts&) = default;
};

// THROWS: Error{kBadInput} at `file`, unless the counts in it are those of the mesh.
void require_same_mesh(const std::string& file, const MeshCounts& in_file, const MeshCounts& in_mesh);

}  // namespace reeb
