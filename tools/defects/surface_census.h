// What else is wrong with the surface whose defects are listed.
#pragma once

#include "ooc/census/mesh_census.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// Reads the mesh two or three times.
// THROWS: Error{kInterrupted}; as ooc::take_census. MEMORY: as that.
ooc::MeshCensus census_of(const MeshSource& source);

}  // namespace reeb::tools
