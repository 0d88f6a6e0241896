#include "ooc/run/compute.h"

#include <utility>

#include "io/file/atomic_file.h"
#include "ooc/run/explained_error.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/freed_memory.h"
#include "ooc/run/run_context.h"
#include "ooc/run/second_stage.h"
#include "ooc/run/stopwatch.h"

namespace reeb::ooc {
namespace {

std::vector<ComputeResult> run_stages(RunContext& run, MeshInput input) {
  // To map the pages again takes a tenth of the time of a run on a tiny mesh.
  const bool keeps_code = run.size == MeshSize::kTiny && run.options.memory_bytes == MemoryBudget::kUnlimited;
  const Stopwatch watch;
  if (!keeps_code) return_code();
  FirstStageResult first = read_mesh(run, std::move(input));
  first.seconds.wall = watch.seconds();
  return_freed_memory();
  if (!keeps_code) return_code();
  std::vector<ComputeResult> results;
  for (std::size_t f = 0; f < run.functions.size(); ++f) results.push_back(run_second_stage(run, first, f));
  run.resumable.done();
  return results;
}

}  // namespace

std::vector<ComputeResult> compute(MeshInput input, std::span<VertexFunction* const> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  for (const std::string& output : outputs) io::require_output_folder(output);
  RunContext run(input, functions, outputs, options);
  try {
    return run_stages(run, std::move(input));
  } catch (...) {
    throw_explained(run);
  }
}

}  // namespace reeb::ooc
