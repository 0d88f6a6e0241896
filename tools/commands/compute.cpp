// `reeb compute MESH`, the default command: from a mesh to its `.reeb` file.
#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/functions/function_source.h"
#include "tools/commands/commands.h"
#include "tools/library/compute.h"
#include "tools/program/compute_report.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/quantity.h"
#include "tools/program/signals.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

struct ComputeArguments {
  std::string mesh, output, memory, report, denoise;
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
  fs::path output = arguments.output.empty() ? stem_of(arguments.mesh) + ".reeb" : arguments.output;
  if (arguments.functions.size() == 1) return {output.string()};
  if (output.extension() == ".reeb") output.replace_extension();
  std::vector<std::string> names;
  for (const std::string& function : arguments.functions)
    names.push_back(output.string() + "-" + io::file_name_part(io::parse_function(function)) + ".reeb");
  return names;
}

std::string describe(const MeshInfo& info) {
  std::string text = info.format;
  if (info.vertex_count) text += fmt::format(", {} vertices", *info.vertex_count);
  if (info.simplex_count) text += fmt::format(", {} faces", *info.simplex_count);
  return text;
}

const char* title(ComputeProgress::Phase phase) {
  using Phase = ComputeProgress::Phase;
  switch (phase) {
    case Phase::kSpool:
      return "reading";
    case Phase::kFinalization:
      return "finalization";
    case Phase::kReeb:
      return "Reeb graph";
    case Phase::kReorder:
      return "reordering";
    case Phase::kHierarchy:
      break;
  }
  return "hierarchy";
}

// CLI::PositiveNumber reports a wrong number as the largest double.
CLI::Validator at_least_one() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool positive = !text.starts_with('-') && text.find_first_of("123456789") != std::string::npos;
        return positive ? std::string() : std::string("must be at least 1");
      },
      "");
}

void run_compute(ComputeArguments arguments) {
  ComputeOptions& options = arguments.options;
  if (arguments.functions.empty()) arguments.functions.push_back("z");
  const std::vector<std::string> outputs = output_names(arguments);
  refuse_existing(arguments.report, options.replace);
  RunFacts facts;
  facts.path = arguments.mesh;
  facts.threads = options.threads;
  if (!arguments.memory.empty()) options.memory_bytes = facts.memory_budget_bytes = parse_size(arguments.memory);
  if (!arguments.denoise.empty()) {
    options.denoise_is_share = arguments.denoise.ends_with('%');
    options.denoise = parse_threshold(arguments.denoise, 1.0);
  }

  options.opened = [&](const MeshInfo& info) {
    facts.format = info.format;
    facts.input_bytes = info.file_bytes;
    if (!arguments.quiet) fmt::print(stderr, "{}: {}\n", arguments.mesh, describe(info));
  };
  ProgressBar bar(arguments.quiet);
  options.progress = [&](const ComputeProgress& p) { bar.update(title(p.phase), p.done, p.total, p.triangles); };
  options.interrupted = watch_signals();
  const auto results = compute(arguments.mesh, arguments.functions, outputs, options);
  bar.clear();
  if (!arguments.quiet) print_summary(facts, results);
  if (!arguments.report.empty())
    write_output(arguments.report, [&](std::ostream& out) { out << report_json(facts, results); });
}

}  // namespace

void add_compute(CLI::App& program) {
  auto arguments = std::make_shared<ComputeArguments>();
  arguments->options.threads = std::max(1u, std::thread::hardware_concurrency());
  // For tests: short runs otherwise end before their first checkpoint.
  if (const char* seconds = std::getenv("REEB_CHECKPOINT_SECONDS"))
    arguments->options.checkpoint_seconds = std::atof(seconds);
  CLI::App* command = program.add_subcommand("compute", "Compute the Reeb graph of a mesh (the default command)");
  command
      ->add_option("MESH", arguments->mesh,
                   "PLY, OBJ, OFF, STL, SMA, SMB, SMC, SVA or SVB, also .gz and .zst; - reads standard input")
      ->required();
  command->add_option("-o,--output", arguments->output, "File to write (default: the mesh's name with .reeb)");
  command
      ->add_option("-f,--function", arguments->functions,
                   "x y z cK index random:SEED property:NAME file:PATH (default z; may be repeated)")
      ->allow_extra_args(false);
  command->add_flag("--graph-only", arguments->options.graph_only, "Stop after the graph: no pairs, no levels");
  command->add_option("--chunk", arguments->options.chunk_triangles, "Triangles per chunk (default: adaptive)")
      ->check(at_least_one());
  command->add_option("--memory", arguments->memory, "Memory that the run may use, as 64M or 1.5GiB");
  command->add_option("--threads", arguments->options.threads, "Threads (default: all)")->check(CLI::Range(1u, 1024u));
  command->add_option("--temp-dir", arguments->options.temp_dir,
                      "Folder for temporary files (default: $TMPDIR, or the output's folder)");
  command->add_option("--denoise", arguments->denoise, "Remove minima and maxima of less persistence: 0.01, or 0.1%");
  command
      ->add_option("--buckets", arguments->options.buckets,
                   "Embed arcs in at least this many buckets of value (0: no embedding; default 64)")
      ->check(CLI::Range(0u, 1u << 20));
  command->add_flag("!--no-reorder", arguments->options.may_reorder, "Do not sort incoherent meshes on disk first");
  command->add_flag("--resume", arguments->options.resume, "Continue an interrupted run from its folder OUT.partial");
  command->add_flag("--sidecar", arguments->options.keep_sidecar, "Keep the finalization as MESH.final for later runs");
  command->add_option("--report", arguments->report, "Write a JSON report (-: to standard output)");
  command
      ->add_option("--snapshot-every", arguments->options.snapshot_every,
                   "Write the graph so far every N triangles, as OUT-000001.reeb, OUT-000002.reeb, ...")
      ->check(at_least_one());
  command->add_flag("--quiet", arguments->quiet, "No progress and no summary");
  command->add_flag("--force", arguments->options.replace, "Replace existing outputs");
  command->footer("Example:\n  reeb compute scan.ply -f z --memory 64M --report report.json");
  command->callback([arguments] { run_compute(*arguments); });
}

}  // namespace reeb::tools
