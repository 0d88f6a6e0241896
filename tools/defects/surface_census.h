// What else is wrong with the surface whose defects are listed.
#pragma once

#include <functional>

#include "ooc/census/mesh_census.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// Reads the mesh two or three times, and asks `interrupted` while it does.
// THROWS: Error{kInterrupted}; as ooc::take_census. MEMORY: as that.
ooc::MeshCensus census_of(const MeshSource& source, const std::function<bool()>& interrupted);

}  // namespace reeb::tools
