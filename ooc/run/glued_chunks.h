// From chunks to the stores of a run: sweeps and glues them, and keeps checkpoints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "libreeb/engine/glue.h"
#include "ooc/checkpoints/checkpoint.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/memory_plan.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// Runs all chunks that are cut from `stretches`, and returns `result` with what it learned. `here` is the content of a
// checkpoint apart from its place. `at_end` is that of PipelineOptions.
// THROWS: as run_pipeline(); Error{kInterrupted}.
FirstStageResult glue_chunks(RunContext& run, ChunkSource& stretches, const MemoryPlan& plan, Checkpoint here,
                             FirstStageResult result,
                             const std::function<void(std::size_t function, const Glue&)>& at_end = {});

// How many listed triangles are degenerate, of the degenerate ones that were read: points and edges are read as such.
std::uint64_t listed_as_degenerate(std::uint64_t read, const SimplexCounts& listed);

}  // namespace reeb::ooc
