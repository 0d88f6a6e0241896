// The second stage of a run: from sorted segments to the file of a Reeb graph.
#pragma once

#include <cstddef>

#include "ooc/run/compute_result.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// Takes the store of this function and writes its output.
// A graph that memory does not hold is paired and cancelled on disk.
// THROWS: Error. If memory does not suffice for the end of noise removal or for the hierarchy, or runs out while the
//         hierarchy is made on disk, the output is the graph alone, and the error says so.
ComputeResult run_second_stage(RunContext& run, const FirstStageResult& first, std::size_t function);

}  // namespace reeb::ooc
