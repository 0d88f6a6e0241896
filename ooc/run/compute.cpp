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

void check_unchanged(const std::function<void()>& check_mesh, std::span<VertexFunction* const> functions) {
  if (check_mesh) check_mesh();
  for (const VertexFunction* function : functions) function->check_unchanged();
}

// Whatever goes wrong with an input that changes is due to the change.
FirstStageResult read_input(RunContext& run, MeshInput input) {
  const std::function<void()> check_mesh = input.check_unchanged;
  const std::string mesh = input.path;
  check_unchanged(check_mesh, run.functions);  // the run was identified by the names of its files
  try {
    FirstStageResult first = run_first_stage(run, std::move(input));
    check_unchanged(check_mesh, run.functions);
    return first;
  } catch (InputChanged& changed) {
    check_unchanged(check_mesh, run.functions);
    changed.at(mesh);
    if (run.resumable.checkpoint() == nullptr) throw;
    throw InputChanged("the mesh has changed since the interrupted run",
                       "start again with --force and without --resume")
        .at(mesh);
  } catch (const std::exception&) {
    check_unchanged(check_mesh, run.functions);
    throw;
  }
}

std::vector<ComputeResult> run_stages(RunContext& run, MeshInput input) {
  const Stopwatch watch;
  FirstStageResult first = read_input(run, std::move(input));
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
