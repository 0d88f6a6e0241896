// The run of a share of a mesh: the pipeline as it is, with what other shares name kept open.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libreeb/parts/open_part.h"
#include "ooc/distributed/part_info.h"
#include "ooc/distributed/part_uses.h"
#include "ooc/distributed/whole_mesh.h"
#include "ooc/run/compute.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// What remains of a share for one function. What has settled is in the store of the run, which is finished.
struct FinishedPart {
  PartInfo info;
  OpenPart open;
  Reservation memory;
};

struct PartResult {
  std::vector<FinishedPart> parts;  // by function
  PhaseSeconds seconds;
  std::vector<std::string> notes;
};

// The options of the run of a share: a threshold that is a share of the range is left to the last pass.
ComputeOptions options_of_share(ComputeOptions options);

// `wanted` are the options of the user, those of the run are options_of_share().
// THROWS: as read_mesh().
PartResult run_part(RunContext& run, const MeshInput& input, WholeMesh& mesh, PartUses& uses, std::uint32_t part,
                    const ComputeOptions& wanted);

}  // namespace reeb::ooc
