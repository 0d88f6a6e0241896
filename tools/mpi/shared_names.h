// Which vertices of a rank's share other ranks name: one exchange with the owners of vertices.
#pragma once

#include "ooc/distributed/part_uses.h"
#include "ooc/distributed/whole_mesh.h"
#include "tools/mpi/world.h"

namespace reeb::tools {

// Rank k has share k, and owns the same part of the vertices, by number. Each rank sends the runs of vertices that it
// names to their owners; these answer with the first and the last rank that names a vertex, where it is not the only
// one.
ooc::PartUses exchange_names(World& world, ooc::RunContext& run, ooc::WholeMesh& mesh);

}  // namespace reeb::tools
