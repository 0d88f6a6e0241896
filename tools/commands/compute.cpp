// `reeb compute MESH`, the default command: from a mesh to its `.reeb` file.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/file/file.h"
#include "io/functions/function_source.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "tools/commands/commands.h"
#include "tools/library/compute.h"
#include "tools/library/run_files.h"
#include "tools/program/compute_report.h"
#include "tools/program/image_options.h"
#include "tools/program/options.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/quantity.h"
#include "tools/program/signals.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

struct ComputeArguments {
  std::string mesh, output, report, denoise;
  std::vector<std::string> functions;
  ComputeOptions options;
  bool quiet = false;
};

// scan.ply.gz -> scan, - -> mesh
std::string stem_of(const std::string& mesh) {
  if (mesh == "-") return "mesh";
  fs::path name = fs::path(mesh).filename();
  if (name.extension() == ".gz" || name.extension() == ".zst") name = name.stem();
  return name.stem().string();
}

std::vector<std::string> output_names(const ComputeArguments& arguments) {
  if (arguments.output == io::kStandardOutput) {
    if (arguments.functions.size() != 1 || arguments.options.snapshot_every != 0)
      throw Error(ErrorKind::kUsage, "several outputs cannot go to standard output", "name a file with -o");
    return {arguments.output};
  }
  fs::path output = arguments.output.empty() ? stem_of(arguments.mesh) + ".reeb" : arguments.output;
  if (arguments.functions.size() == 1) return {output.string()};
  if (output.extension() == ".reeb") output.replace_extension();
  std::vector<std::string> names;
  for (const std::string& function : arguments.functions)
    names.push_back(output.string() + "-" + io::file_name_part(io::parse_function(function)) + ".reeb");
  return names;
}

// With the report, which compute() does not know.
void check_files(const ComputeArguments& arguments, const std::vector<std::string>& outputs) {
  std::vector<io::FunctionSpec> functions;
  for (const std::string& function : arguments.functions)
    if (!function.empty()) functions.push_back(io::parse_function(function));
  RunFiles files = files_of_run(arguments.mesh, functions, outputs, arguments.options);
  if (!arguments.report.empty())
    files.add_output(arguments.report, "the report", existing_outputs(arguments.options.replace));
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

void run_compute(ComputeArguments arguments) {
  ComputeOptions& options = arguments.options;
  if (arguments.functions.empty()) arguments.functions.emplace_back();
  const std::vector<std::string> outputs = output_names(arguments);
  check_files(arguments, outputs);
  RunFacts facts;
  facts.path = arguments.mesh;
  facts.threads = options.threads;
  if (options.memory_bytes != MemoryBudget::kUnlimited) facts.memory_budget_bytes = options.memory_bytes;
  if (!arguments.denoise.empty()) {
    options.denoise_is_share = arguments.denoise.ends_with('%');
    options.denoise = parse_threshold("--denoise", arguments.denoise, 1.0);
  }

  options.opened = [&](const MeshInfo& info) {
    facts.format = info.format;
    facts.input_bytes = info.file_bytes;
    if (!arguments.quiet) print_line(printable(arguments.mesh + ": " + describe(info)));
  };
  ProgressBar bar(arguments.quiet);
  options.progress = [&](const ComputeProgress& p) { bar.update(pass_of(p.phase), p.done, p.total, p.triangles); };
  // Only a run on a file can be saved and resumed.
  if (io::is_regular_file(arguments.mesh)) options.interrupted = watch_signals();
  const auto results = compute(arguments.mesh, arguments.functions, outputs, options);
  bar.clear();
  if (!arguments.quiet) print_summary(facts, results);
  if (!arguments.report.empty())
    write_output(arguments.report, options.replace, [&](std::ostream& out) { out << report_json(facts, results); });
}

}  // namespace

void add_compute(CLI::App& program) {
  auto arguments = std::make_shared<ComputeArguments>();
  arguments->options.threads = std::max(1u, std::thread::hardware_concurrency());
  // For tests: short runs otherwise end before their first checkpoint.
  if (const char* seconds = std::getenv("REEB_CHECKPOINT_SECONDS"))
    arguments->options.checkpoint_seconds = std::atof(seconds);
  ComputeOptions& options = arguments->options;
  CLI::App* command = program.add_subcommand("compute", "Compute the Reeb graph of a mesh (the default)");
  command
      ->add_option("MESH", arguments->mesh, "Mesh or image of any format, also as .gz and .zst; - reads standard input")
      ->required()
      ->type_name("");
  command
      ->add_option(
          "-o,--output", arguments->output,
          "File to write; - is standard output (default: the name of the mesh with .reeb, in the current folder; "
          "mesh.reeb for standard input)")
      ->type_name("FILE");
  command
      ->add_option(
          "-f,--function", arguments->functions,
          "x, y, z, cK (the K-th coordinate, from 0), index, random:SEED, property:NAME, file:PATH, "
          "distance:VERTEX, distance:X,Y,Z, geodesic:VERTEX[,VERTEX...], laplacian:K, spectral, or of an image value, "
          "value:K (default: z, of an image value; may be repeated)")
      ->allow_extra_args(false)
      ->option_text("FUNC");
  command->add_flag("--graph-only", options.graph_only, "Stop after the graph: no pairs, no levels");
  add_format(*command, options.format);
  add_size(*command, "--memory", options.memory_bytes, "Memory that the run may use: 64M, 1.5GiB (default: no limit)");
  command
      ->add_option("--denoise", arguments->denoise,
                   "Remove minima and maxima of less persistence: 0.01 (function units), or 0.1% (of the range)")
      ->type_name("T");
  add_count(*command, "--buckets", options.buckets,
            "Embed arcs in at least N buckets of value (default: 64; 0: no embedding)", {.most = 1u << 20});
  add_image_options(*command, arguments->options.image);
  add_count(*command, "--threads", options.threads, "Number of threads, 1 to 1024 (default: all)",
            {.least = 1, .most = 1024});
  add_count(*command, "--chunk", options.chunk_triangles, "Triangles per chunk (default: adaptive)", {.least = 1});
  command
      ->add_option("--temp-dir", options.temp_dir,
                   "Folder for temporary files (default: $TMPDIR, or the folder of the output)")
      ->type_name("DIR");
  command->add_flag("--manifold", options.manifold, "Drop each edge after two triangles; a third one is an error");
  command->add_flag_callback(
      "--no-reorder", [&options] { options.may_reorder = false; }, "Do not sort incoherent meshes on disk first");
  command->add_flag("--sidecar", options.keep_sidecar, "Keep what the first pass finds in MESH.final, for later runs");
  command->add_flag("--resume", options.resume, "Continue an interrupted run from its folder OUT.partial");
  add_count(*command, "--snapshot-every", options.snapshot_every,
            "Write the graph so far every N triangles, as OUT-000001.reeb, OUT-000002.reeb, ...", {.least = 1});
  command->add_option("--report", arguments->report, "Write figures of the run as JSON; - is standard output")
      ->type_name("FILE");
  command->add_flag("--quiet", arguments->quiet, "Print no progress and no summary");
  command->add_flag("--force", options.replace, "Replace existing outputs, and discard an interrupted run");
  command->footer("Example:\n  reeb compute scan.ply -f z --memory 64M --report report.json");
  command->callback([arguments] { run_compute(*arguments); });
}

}  // namespace reeb::tools
