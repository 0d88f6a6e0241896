// A mesh that a program holds, as its reader delivers it.
#pragma once

#include <memory>

#include "tools/library/compute.h"

namespace reeb {

// Calls `open`, and returns its reader with a check of each batch: other code relies on what mesh_reader.h says.
// THROWS: Error{kBadInput}: `open` returns no reader, the mesh has no coordinates, or lacks a property that is wanted.
//         The reader throws Error{kBadInput} at a batch that breaks a rule.
// TIME:   a look at each number of a vertex.
std::unique_ptr<MeshReader> open_held(const MeshOpener& open, const ReadOptions& options);

}  // namespace reeb
