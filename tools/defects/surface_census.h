// What else is wrong with the surface whose defects are listed.
#pragma once

#include "ooc/census/mesh_census.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// Reads the mesh two or three times. THROWS, MEMORY: as ooc::take_census.
ooc::MeshCensus census_of(const MeshSource& source);

}  // namespace reeb::tools
