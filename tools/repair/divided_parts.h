// Which of many cuts divide a surface.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ooc/whole_mesh/workspace.h"
#include "tools/defects/valued_mesh.h"
#include "tools/repair/mesh_edits.h"

namespace reeb::tools {

// A vertex on either side of a cut; nothing if none is left.
struct RimPair {
  std::uint32_t job = 0;
  std::optional<VertexRef> first, second;
};

// The jobs that should not be done, the last ones first, with the reason: without them, no two sides of a cut lie in
// different components of the edited mesh. Reads the mesh once.
// MEMORY: at most 24 MiB and an eighth of the budget, reserved; the rest of 8 bytes per vertex is in a temporary file.
// THROWS: Error{kResource} of the budget or the disk.
// REQUIRES: pairs ascend by their jobs.
std::vector<std::pair<std::uint32_t, std::string>> dividing_curves(
    const ValuedMesh& mesh, const MeshEdits& edits, std::uint64_t mesh_vertices, const std::vector<RimPair>& pairs,
    ooc::Workspace& space, const std::function<void(std::uint64_t done, std::uint64_t total)>& progress);

}  // namespace reeb::tools
