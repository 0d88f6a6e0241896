#include "tools/library/compute.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "io/file/atomic_file.h"
#include "io/file/temp_dir.h"
#include "io/functions/function_source.h"
#include "libreeb/base/error.h"
#include "ooc/run/compute.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/library/snapshots.h"

namespace reeb {
namespace {

ooc::ComputeOptions run_options(const ComputeOptions& options) {
  ooc::ComputeOptions run;
  run.memory_bytes = options.memory_bytes;
  run.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  run.chunk_triangles = options.chunk_triangles;
  run.temp_dir = options.temp_dir;
  run.replace = options.replace;
  run.graph_only = options.graph_only;
  run.keep_sidecar = options.keep_sidecar;
  run.may_reorder = options.may_reorder;
  run.buckets = options.buckets;
  run.manifold = options.manifold;
  run.denoise = options.denoise;
  run.denoise_is_share = options.denoise_is_share;
  run.resume = options.resume;
  run.checkpoint_seconds = options.checkpoint_seconds;
  // The stages of a run are in several threads.
  const auto one_at_a_time = std::make_shared<std::mutex>();
  if (options.progress)
    run.progress = [one_at_a_time, tell = options.progress](const ComputeProgress& progress) {
      const std::lock_guard lock(*one_at_a_time);
      tell(progress);
    };
  if (options.interrupted)
    run.interrupted = [one_at_a_time, ask = options.interrupted] {
      const std::lock_guard lock(*one_at_a_time);
      return ask();
    };
  return run;
}

void require_an_output_each(std::span<const std::string> functions, std::span<const std::string> outputs) {
  if (functions.empty() || functions.size() != outputs.size())
    throw Error(ErrorKind::kUsage,
                "there are " + std::to_string(functions.size()) + " functions and " + std::to_string(outputs.size()) +
                    " outputs",
                "name one output for each function, and at least one function");
}

}  // namespace

std::vector<ComputeResult> compute(const std::string& path, std::span<const std::string> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  std::vector<io::FunctionSpec> specs;
  for (const std::string& function : functions)
    specs.push_back(function.empty() ? io::FunctionSpec() : io::parse_function(function));
  require_an_output_each(functions, outputs);
  files_of_run(path, specs, outputs, options).check();

  const bool snapshots = options.snapshot_every != 0;
  InputOptions input_options{
      .format = options.format,
      .image = options.image,
      .temp_dir = options.temp_dir.empty() ? io::TempDir::default_folder(outputs.front()) : options.temp_dir,
      .memory_bytes = options.memory_bytes};
  if (snapshots) input_options.batch_events = 1;  // exactly as far as the stream came
  RunInput input(path, functions, input_options);
  const std::span<VertexFunction* const> pointers = input.functions();
  if (options.opened) options.opened(input.info());
  ooc::MeshInput mesh;
  if (snapshots) {
    for (const VertexFunction* function : pointers)
      if (function->needs_lookup())
        throw Error(ErrorKind::kUsage, "no graph of a part of the mesh has values of " + function->name(),
                    "name a point: distance:X,Y,Z; or leave snapshots out");
    mesh = input.take_reader();
    mesh.may_resume = false;
    mesh.reader = with_snapshots(std::move(mesh.reader), options.snapshot_every, pointers, outputs,
                                 options.replace ? io::Existing::kReplace : io::Existing::kKeep);
  } else {
    mesh = input.take_mesh();
  }
  auto results = ooc::compute(std::move(mesh), pointers, outputs, run_options(options));
  for (std::size_t i = 0; i < results.size(); ++i)
    results[i].notes.insert(results[i].notes.end(), input.notes(i).begin(), input.notes(i).end());
  return results;
}

ComputeResult compute(const std::string& path, const std::string& function, const std::string& output,
                      const ComputeOptions& options) {
  return std::move(compute(path, std::span(&function, 1), std::span(&output, 1), options).front());
}

}  // namespace reeb
