#include "ooc/run/compute.h"

#include <exception>
#include <functional>
#include <new>
#include <utility>

#include "io/file/atomic_file.h"
#include "libreeb/base/error.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/freed_memory.h"
#include "ooc/run/run_context.h"
#include "ooc/run/second_stage.h"
#include "ooc/run/stopwatch.h"

namespace reeb::ooc {
namespace {

std::vector<ComputeResult> run_stages(RunContext& run, MeshInput input) {
  const Stopwatch watch;
  FirstStageResult first = read_mesh(run, std::move(input));
  first.seconds.wall = watch.seconds();
  return_freed_memory();
  std::vector<ComputeResult> results;
  for (std::size_t f = 0; f < run.functions.size(); ++f) results.push_back(run_second_stage(run, first, f));
  run.resumable.done();
  return results;
}

}  // namespace

std::vector<ComputeResult> compute(MeshInput input, std::span<VertexFunction* const> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  for (const std::string& output : outputs) io::require_output_folder(output);
  // From here on an interruption ends the run in order.
  if (options.interrupted && options.interrupted()) throw Error(ErrorKind::kInterrupted, "interrupted", "run it again");
  RunContext run(input, functions, outputs, options);
  try {
    return run_stages(run, std::move(input));
  } catch (const Error& error) {
    throw run.resumable.explain(error);
  } catch (const std::bad_alloc&) {
    throw run.resumable.explain(
        Error(ErrorKind::kResource, "out of memory", "close other programs, or allow less with --memory SIZE"));
  } catch (const std::exception&) {
    // What the program found impossible was in the state that it was given.
    if (run.resumable.checkpoint() == nullptr) throw;
    throw run.resumable.explain(
        Error(ErrorKind::kBadInput, "the checkpoint of the interrupted run is damaged", "run it again without --resume")
            .at(outputs[0]));
  }
}

}  // namespace reeb::ooc
