#include "tools/runs/run_options.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "io/functions/function_spec.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/library/run_files.h"
#include "tools/program/output.h"
#include "tools/program/quantity.h"

namespace reeb::tools {

RunArguments::RunArguments() {
  // For tests: short runs otherwise end before their first checkpoint.
  if (const char* seconds = std::getenv("REEB_CHECKPOINT_SECONDS")) options.checkpoint_seconds = std::atof(seconds);
}

void add_run_options(Command command, RunArguments& arguments, const RunTexts& texts) {
  ComputeOptions& options = arguments.options;
  command
      .add_option(
          "-f,--function", arguments.functions,
          "x, y, z, cK (the K-th coordinate, from 0), index, random:SEED, property:NAME, file:PATH, "
          "distance:VERTEX, distance:X,Y,Z, geodesic:VERTEX[,VERTEX...], laplacian:K, spectral, or of an image value, "
          "value:K (default: z, of an image value; may be repeated)")
      .one_value_each_time()
      .option_text("FUNC");
  command.add_flag("--graph-only", options.graph_only, "Stop after the graph: no pairs, no levels");
  add_format(command, options.format);
  add_memory(command, options.memory_bytes, texts.memory);
  command
      .add_option("--denoise", arguments.denoise,
                  "Remove minima and maxima of less persistence: 0.01 (function units), or 0.1% (of the range)")
      .type_name("T");
  add_count(command, "--buckets", options.buckets,
            "Embed arcs in at least N buckets of value (default: 64; 0: no embedding)", {.most = kMostBuckets});
  add_image_options(command, arguments.options.image);
  add_threads(command, options.threads, texts.threads);
  add_count(command, "--chunk", options.chunk_triangles,
            "Triangles per chunk, or vertices per box of an image (default: adaptive)", {.least = 1});
  add_temp_dir(command, options.temp_dir);
  command.add_flag(
      "--no-reorder", [&options] { options.may_reorder = false; }, "Do not sort incoherent meshes on disk first");
  command.add_flag("--resume", options.resume, "Continue an interrupted run from its folder OUT.partial");
  add_quiet(command, arguments.quiet);
  add_force(command, options.replace, "Replace existing outputs, and discard an interrupted run");
}

void refuse_whole_mesh_options(Command command) {
  command.refuse_option("--manifold", "a part does not see the triangles that others have at its edges",
                        "leave it out; the graph is the same");
  command.refuse_option("--sidecar", "a run on parts keeps no sidecar",
                        "leave it out, or make one with `reeb compute --sidecar`; a sidecar that is there is used");
  command.refuse_option("--snapshot-every", "parts have no graph of the mesh so far",
                        "use `reeb compute` for snapshots");
}

void take_denoise(RunArguments& arguments) {
  if (arguments.denoise.empty()) return;
  arguments.options.denoise_is_share = arguments.denoise.ends_with('%');
  arguments.options.denoise = parse_threshold("--denoise", arguments.denoise, {0, 1});
}

std::vector<std::string> output_names(std::filesystem::path output, const std::vector<std::string>& functions,
                                      std::string_view suffix) {
  if (functions.size() == 1) return {output.string()};
  require_room_for_several(output.string());
  if (output.extension() == suffix) output.replace_extension();
  std::vector<std::string> names;
  names.reserve(functions.size());
  for (const std::string& function : functions)
    names.push_back(output.string() + "-" + io::file_name_part(io::parse_function(function)) + std::string(suffix));
  return names;
}

void check_functions(const std::vector<std::string>& functions) {
  for (const std::string& function : functions)
    if (std::ranges::count(functions, function) > 1)
      throw Error(ErrorKind::kBadInput, "-f " + function + " is given twice", "name each function once");
}

void check_files(const RunArguments& arguments, const std::vector<std::string>& outputs, const std::string& report) {
  std::vector<io::FunctionSpec> functions;
  for (const std::string& function : arguments.functions)
    if (!function.empty()) functions.push_back(io::parse_function(function));
  check_functions(arguments.functions);
  RunFiles files = files_of_run(arguments.mesh, functions, outputs, arguments.options);
  if (!report.empty())
    files.add_output(report, "the report", existing_outputs(arguments.options.replace), "with --report FILE");
  files.check();
}

std::string describe(const MeshInfo& info) {
  std::string text = info.format;
  if (info.vertex_count) text += ", " + count_of(*info.vertex_count, "vertex");
  const bool has_faces = std::ranges::any_of(std::array{"PLY", "OFF", "STL", "SM"},
                                             [&](const char* format) { return info.format.starts_with(format); });
  if (info.simplex_count) text += ", " + count_of(*info.simplex_count, has_faces ? "face" : "cell");
  return text;
}

ProgressBar::Pass pass_of(ComputeProgress::Phase phase) {
  using Phase = ComputeProgress::Phase;
  switch (phase) {
    case Phase::kSpool:
      return {"reading", 3};
    case Phase::kFinalization:
      return {"reading", 2};
    case Phase::kReorder:
      return {"sorting on disk", 2};
    case Phase::kReeb:
      return {"Reeb graph", 1};
    case Phase::kHierarchy:
      break;
  }
  return {"simplification", 0};
}

}  // namespace reeb::tools
