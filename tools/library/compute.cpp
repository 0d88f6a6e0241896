#include "tools/library/compute.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/content_source.h"
#include "io/file/temp_dir.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "io/functions/mesh_field.h"
#include "libreeb/base/error.h"
#include "ooc/run/compute.h"
#include "tools/library/run_files.h"
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
  run.denoise = options.denoise;
  run.denoise_is_share = options.denoise_is_share;
  run.progress = options.progress;
  run.resume = options.resume;
  run.checkpoint_seconds = options.checkpoint_seconds;
  run.interrupted = options.interrupted;
  return run;
}

// What a run on an image depends on and its file does not say.
std::uint64_t reading_digest(const MeshInfo& info, const io::ImageOptions& image) {
  if (!info.grid) return 0;
  std::uint64_t digest = image.skip_nodata ? 1 : 0;
  const auto add = [&](const auto& numbers) { digest = io::checksum(std::as_bytes(std::span(numbers)), digest); };
  add(info.grid->size);
  add(info.grid->origin);
  add(std::span(info.format));
  for (const auto& step : info.grid->step) add(step);
  return digest;
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
  ReadOptions read_options;
  read_options.batch_events = 8192;              // a few hundred KiB, beside chunks on their way
  if (snapshots) read_options.batch_events = 1;  // exactly as far as the stream came
  read_options.properties = io::needed_properties(specs);
  read_options.temp_folder = options.temp_dir.empty() ? io::TempDir::default_folder(outputs.front()) : options.temp_dir;
  read_options.value_of_image = functions[0].empty();

  ooc::MeshInput input;
  input.path = path;
  input.may_resume = !snapshots;
  const io::Input mesh = io::mesh_input(path, options.format);
  input.check_unchanged = [&] { mesh.check_unchanged(); };
  auto content = mesh.open();
  // What zstd holds with the window of its usual level, 2 MiB, is part of what any run takes.
  constexpr std::uint64_t kUsualWindow = std::uint64_t{3} << 20;
  input.reader_bytes = content->memory_bytes() - std::min(content->memory_bytes(), kUsualWindow);
  input.reader = io::open_mesh(mesh, std::move(content), read_options, options.image, options.format);
  const MeshInfo info = input.reader->info();
  for (std::size_t f = 0; f < specs.size(); ++f)
    if (functions[f].empty()) specs[f] = io::default_function(info);
  if (read_options.properties.empty()) read_options.properties = io::needed_properties(specs);
  input.reading = reading_digest(info, options.image);
  input.dimension = info.dimension;
  std::vector<std::unique_ptr<io::FunctionSource>> sources;
  std::vector<VertexFunction*> pointers;
  io::OpenMesh open_again;
  if (mesh.can_reopen())
    open_again = [&] { return io::open_mesh(mesh, mesh.open(), {}, options.image, options.format); };
  const std::vector<io::MeshField> fields =
      io::read_fields(specs, open_again, path, read_options.temp_folder, options.memory_bytes);
  for (std::size_t i = 0; i < specs.size(); ++i) {
    sources.push_back(std::make_unique<io::FunctionSource>(specs[i], info, read_options.properties, path, &fields[i]));
    pointers.push_back(sources.back().get());
  }
  if (options.opened) options.opened(info);
  if (snapshots) {
    for (const VertexFunction* function : pointers)
      if (function->needs_lookup())
        throw Error(ErrorKind::kUsage, "no graph of a part of the mesh has values of " + function->name(),
                    "name a point: distance:X,Y,Z; or leave snapshots out");
    input.reader = with_snapshots(std::move(input.reader), options.snapshot_every, pointers, outputs,
                                  options.replace ? io::Existing::kReplace : io::Existing::kKeep);
  } else {
    input.indexed = input.reader->indexed();
    if (path != "-")
      input.read_again = [&] { return io::open_mesh(mesh, mesh.open(), read_options, options.image, options.format); };
  }
  if (input.indexed) input.reader.reset();
  auto results = ooc::compute(std::move(input), pointers, outputs, run_options(options));
  for (std::size_t i = 0; i < results.size(); ++i)
    results[i].notes.insert(results[i].notes.end(), fields[i].notes.begin(), fields[i].notes.end());
  return results;
}

ComputeResult compute(const std::string& path, const std::string& function, const std::string& output,
                      const ComputeOptions& options) {
  return std::move(compute(path, std::span(&function, 1), std::span(&output, 1), options).front());
}

}  // namespace reeb
