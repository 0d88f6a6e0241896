// The second stage of a run: from sorted segments to the file of a Reeb graph.
#pragma once

#include <cstddef>

#include "ooc/run/compute.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// Takes the store of this function and writes its output.
// THROWS: Error. Whether noise removal and the hierarchy fit in memory is known before their work starts. If they do
//         not, the output is the graph alone, and the error says so.
ComputeResult run_second_stage(RunContext& run, const FirstStageResult& first, std::size_t function);

}  // namespace reeb::ooc
