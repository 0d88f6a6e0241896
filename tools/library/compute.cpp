#include "tools/library/compute.h"

#include <utility>

#include "io/file/atomic_file.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/run/compute.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/library/run_options.h"
#include "tools/library/snapshots.h"

namespace reeb {
namespace {

// Why a run keeps no sidecar; empty if it does.
std::string no_sidecar(const std::string& path, const MeshInfo& info, const ComputeOptions& options) {
  if (!options.keep_sidecar || ooc::is_sidecar(path + ".final")) return {};
  const std::string what = "no sidecar was kept: ";
  if (path == "-") return what + "there is no file beside which it would lie";
  if (info.finalizes) return what + "this stream finalizes its vertices itself";
  if (info.grid) return what + "an image needs none";
  if (options.chunk_triangles != 0) return what + "it is for chunks of the usual size, and --chunk was given";
  return what + "this run did not look for the last uses of vertices";
}

// `mesh_source` is the path, or opens a mesh that the caller holds; `path` is "-" then.
template <class Mesh>
std::vector<ComputeResult> compute_all(const Mesh& mesh_source, const std::string& path,
                                       std::span<const std::string> functions, std::span<const std::string> outputs,
                                       const ComputeOptions& options) {
  const std::vector<io::FunctionSpec> specs = parse_functions(functions);
  require_an_output_each(functions, outputs);
  check_limits(options);
  files_of_run(path, specs, outputs, options).check();

  const bool snapshots = options.snapshot_every != 0;
  InputOptions reading = input_options(options, outputs.front());
  if (snapshots) reading.batch_events = 1;  // exactly as far as the stream came
  RunInput input(mesh_source, functions, reading);
  const std::span<VertexFunction* const> pointers = input.functions();
  if (options.opened) options.opened(input.info());
  ooc::MeshInput mesh;
  if (snapshots) {
    for (const VertexFunction* function : pointers)
      if (function->needs_lookup())
        throw Error(ErrorKind::kUsage,
                    "there can be no snapshots of " + function->name() + ", whose vertex may come late",
                    "name a point: distance:X,Y,Z; or leave snapshots out");
    mesh = input.take_reader();
    mesh.may_resume = false;
    mesh.reader = with_snapshots(std::move(mesh.reader), options.snapshot_every, pointers, outputs,
                                 options.replace ? io::Existing::kReplace : io::Existing::kKeep);
  } else {
    mesh = input.take_mesh();
    mesh.may_resume &= options.keeps_checkpoints;
  }
  auto results = ooc::compute(std::move(mesh), pointers, outputs, run_options(options));
  for (std::size_t i = 0; i < results.size(); ++i)
    results[i].notes.insert(results[i].notes.end(), input.notes(i).begin(), input.notes(i).end());
  if (const std::string note = no_sidecar(path, input.info(), options); !note.empty())
    results.front().notes.push_back(note);
  return results;
}

}  // namespace

std::vector<ComputeResult> compute(const std::string& path, std::span<const std::string> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  return compute_all(path, path, functions, outputs, options);
}

std::vector<ComputeResult> compute(const MeshOpener& mesh, std::span<const std::string> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  if (!mesh) throw Error(ErrorKind::kUsage, "there is no mesh", "name what opens it");
  return compute_all(mesh, "-", functions, outputs, options);
}

ComputeResult compute(const std::string& path, const std::string& function, const std::string& output,
                      const ComputeOptions& options) {
  return std::move(compute(path, std::span(&function, 1), std::span(&output, 1), options).front());
}

}  // namespace reeb
