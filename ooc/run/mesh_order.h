// The order in which an indexed mesh is glued, and what must be known before (docs/ARCHITECTURE.md, The order of a
// mesh).
//
// There are three: that of the mesh; its pieces in another order; and sorted on disk. The choice is made from the front
// of each, which is known, or can be expected, before anything is glued.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/checkpoints/checkpoint.h"
#include "ooc/chunks/last_use.h"
#include "ooc/run/memory_plan.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

struct OrderedMesh {
  std::unique_ptr<IndexedMesh> mesh;  // reads in the chosen order
  ChunkOrigin origin = ChunkOrigin::kLookedUp;
  LastUse uses;             // in that order
  bool of_sidecar = false;  // uses are those of the sidecar, and `mesh` is the one that was passed
  MemoryPlan plan;
  std::uint64_t spilled_bytes = 0;
  PhaseSeconds seconds;
  std::vector<std::string> notes;
};

// Reads the mesh once or twice, without its vertices; more often only if it is sorted. A run that is resumed keeps the
// order in which it began: `start` is its checkpoint, or null. A sidecar is read only if it may be used.
// THROWS: Error, of the input, the budget or the disk, or because the run was interrupted; Error{kResource} if the live
//         graphs cannot fit.
OrderedMesh order_mesh(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh> mesh,
                       const Checkpoint* start, bool use_sidecar);

// The memory of values that functions keep, to look up vertices.
// THROWS: Error{kBadInput} if their number is not that of the vertices.
Reservation prepare_values(RunContext& run, std::uint64_t vertices);

// Where last uses are kept for later runs. Empty if no sidecar is used: with a chosen chunk size its blocks can be too
// large for small chunks.
std::string sidecar_path(const RunContext& run, const MeshInput& input);

}  // namespace reeb::ooc
