// `reeb compute MESH`, the default command: from a mesh to its `.reeb` file.
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/compute.h"
#include "tools/program/compute_report.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/quantity.h"
#include "tools/program/signals.h"
#include "tools/program/wrapping.h"
#include "tools/runs/run_options.h"

namespace reeb::tools {
namespace {

constexpr const char* kLevelsHint = "levels are chosen afterwards: `reeb extract FILE.reeb --threshold 1%`";

struct ComputeArguments : RunArguments {
  std::string output, report;
};

std::vector<std::string> outputs_of(const ComputeArguments& arguments) {
  return output_names(arguments.output.empty() ? stem_of(arguments.mesh) + ".reeb" : arguments.output,
                      arguments.functions);
}

void note_large_denoise(const std::string& threshold, const ooc::ComputeResult& result) {
  if (threshold.empty()) return;
  const std::string note = large_threshold(threshold, result.range, result.function);
  if (!note.empty()) print_line("note: " + printable(note));
}

// Whether mpirun started several of these.
bool is_one_of_many() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(name); size != nullptr && std::atoi(size) > 1) return true;
  return false;
}

// Of the processes that mpirun starts, one writes the output, and the others cannot.
Error with_hint_of_mpi(const Error& error) {
  const bool is_taken = error.cause() == ErrorCause::kExists || error.file().ends_with(".partial");
  return is_taken && is_one_of_many() ? error.with_hint("under mpirun, use reeb-mpi: reeb-mpi compute MESH -o OUT.reeb")
                                      : error;
}

void run_compute(ComputeArguments arguments) {
  ComputeOptions& options = arguments.options;
  if (arguments.functions.empty()) arguments.functions.emplace_back();
  const std::vector<std::string> outputs = outputs_of(arguments);
  take_denoise(arguments);
  check_files(arguments, outputs, arguments.report);
  RunFacts facts;
  facts.path = arguments.mesh;
  if (options.memory_bytes != MemoryBudget::kUnlimited) facts.memory_budget_bytes = options.memory_bytes;

  options.opened = [&](const MeshInfo& info) {
    facts.format = info.format;
    facts.input_bytes = info.file_bytes;
    facts.is_image = info.grid.has_value();
    if (!arguments.quiet) print_line(printable(arguments.mesh + ": " + describe(info)));
  };
  ProgressBar bar(arguments.quiet);
  options.progress = [&](const ComputeProgress& p) { bar.update(pass_of(p.phase), p.done, p.total, p.triangles); };
  // Only a run on a file can be saved and resumed.
  if (io::is_regular_file(arguments.mesh)) options.interrupted = watch_signals();
  const auto results = compute(arguments.mesh, arguments.functions, outputs, options);
  options.interrupted = {};
  bar.clear();
  if (!arguments.quiet) {
    for (const ooc::ComputeResult& result : results) note_large_denoise(arguments.denoise, result);
    print_summary(facts, results);
    for (const std::string& output : outputs) note_other_suffix(output, {".reeb"}, "a .reeb file");
  }
  if (!arguments.report.empty())
    write_output(arguments.report, options.replace, [&](std::ostream& out) { out << report_json(facts, results); });
}

}  // namespace

void add_compute(Program& program) {
  auto arguments = std::make_shared<ComputeArguments>();
  ComputeOptions& options = arguments->options;
  Command command = program.add_command("compute", "Compute the Reeb graph of a mesh (the default)");
  command
      .add_option("MESH", arguments->mesh, "Mesh or image of any format, also as .gz and .zst; - reads standard input")
      .required()
      .type_name("");
  command
      .add_option(
          "-o,--output", arguments->output,
          "File to write; - is standard output (default: the name of the mesh with .reeb, in the current folder; "
          "mesh.reeb for standard input)")
      .type_name("FILE");
  add_run_options(command, *arguments);
  command.add_flag("--manifold", options.manifold,
                   "Expect at most two triangles per edge (saves memory); a third is an error");
  command.add_flag("--sidecar", options.keep_sidecar, "Keep what the first pass finds in MESH.final, for later runs");
  add_count(command, "--snapshot-every", options.snapshot_every,
            "Write the graph so far every N triangles, as OUT-000001.reeb, OUT-000002.reeb, ...", {.least = 1});
  command.add_option("--report", arguments->report, "Write figures of the run as JSON; - is standard output")
      .type_name("FILE");
  command.refuse_option("--threshold", "the file has all levels", kLevelsHint);
  command.footer("Example:\n  reeb compute scan.ply -f z --memory 64M --report report.json");
  command.callback([arguments] {
    try {
      run_compute(*arguments);
    } catch (const Error& error) {
      throw with_hint_of_mpi(error);
    }
  });
}

}  // namespace reeb::tools
