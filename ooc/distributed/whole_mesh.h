// A mesh of which a run computes a share, and which shares name its vertices.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/distributed/part_info.h"
#include "ooc/distributed/part_uses.h"
#include "ooc/run/compute.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

struct WholeMesh {
  std::unique_ptr<MeshShare> share(std::uint32_t part) const {
    return std::make_unique<MeshShare>(*mesh, info.shares.begin(part), info.shares.end(part), by_size);
  }

  std::unique_ptr<IndexedMesh> mesh;
  WholeMeshInfo info;
  bool by_size = false;  // triangles were not counted: see IndexedMesh::triangles_by_size()
  std::uint64_t spilled_bytes = 0;
  std::vector<std::string> notes;
};

// Counts the triangles of the mesh: from sizes where these tell, else it reads the mesh once. One that is not indexed
// is spooled.
WholeMesh open_whole_mesh(RunContext& run, MeshInput& input, std::uint32_t parts);

// Counts the triangles whatever sizes tell: reads the mesh once.
void count_triangles(RunContext& run, WholeMesh& mesh);

// From the sidecar of the mesh, if there is one that fits; else reads the whole mesh. Counts the triangles if it shows
// that sizes do not tell their number.
PartUses find_part_uses(RunContext& run, const MeshInput& input, WholeMesh& mesh);

// An empty table of uses by shares, to be filled with UseEntry::used_by().
PagedTable<std::uint32_t> empty_uses(RunContext& run);
// A table that was filled. `if_wrong` as in PartUses.
PartUses uses_of_table(PagedTable<std::uint32_t> table, const Shares& shares, Error if_wrong = input_changed());

}  // namespace reeb::ooc
