// The vertex of each component of a mesh whose first coordinate is greatest: where the orientation can be seen.
#pragma once

#include <cstddef>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "tools/defects/loop_list.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// Of each component of function number `number` that has loops, in the order of its tops. Reads the mesh twice; once if
// it has one component. MEMORY: 4 bytes a vertex of the mesh from the budget, if it has several components. THROWS:
// Error{kResource} if they do not fit.
std::vector<SettledNode> component_tops(const ValuedMesh& mesh, const LoopFunction& function, std::size_t number,
                                        MemoryBudget& budget);

}  // namespace reeb::tools
