// `reeb glue FRAGMENT...`: from the fragments of parts to the graph of the mesh, or to a fragment of more parts.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "ooc/distributed/glue_run.h"
#include "ooc/distributed/part_union.h"
#include "tools/arguments/options.h"
#include "tools/library/run_files.h"
#include "tools/program/compute_report.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/signals.h"
#include "tools/program/wrapping.h"
#include "tools/runs/fragment_commands.h"
#include "tools/runs/run_options.h"

namespace reeb::tools {
namespace {

struct GlueArguments {
  std::vector<std::string> fragments;
  std::string output, report;
  bool quiet = false;
  ooc::GlueOptions options;
};

// THROWS: Error{kUsage} if the name tells neither.
bool writes_fragment(const std::string& output) {
  const std::filesystem::path path = output;
  if (path.extension() == ".fragment") return true;
  if (path.extension() == ".reeb" || io::is_device(output)) return false;
  throw Error(ErrorKind::kUsage, "the name of the output must end in .reeb or .fragment",
              "for instance -o scan.reeb: the graph of the mesh; -o half.fragment: to be glued again")
      .at(output);
}

void run_glue(GlueArguments arguments) {
  ooc::GlueOptions& options = arguments.options;
  const bool as_fragment = writes_fragment(arguments.output);
  if (as_fragment && !arguments.report.empty())
    throw Error(ErrorKind::kUsage, "there is no report of a fragment", "leave out --report");
  RunFiles files;
  for (const std::string& fragment : arguments.fragments) files.add_input(fragment, "a fragment");
  files.add_output(arguments.output, "the output", existing_outputs(options.replace));
  if (!arguments.report.empty())
    files.add_output(arguments.report, "the report", existing_outputs(options.replace), "with --report FILE");
  files.check();
  for (const std::string& fragment : arguments.fragments) require_fragment(fragment);

  ProgressBar bar(arguments.quiet);
  options.progress = [&](const ComputeProgress& p) { bar.update(pass_of(p.phase), p.done, p.total, p.triangles); };
  options.interrupted = watch_signals();
  const ooc::GlueResult glued = ooc::glue_fragments(arguments.fragments, arguments.output, as_fragment, options);
  options.interrupted = {};
  bar.clear();
  RunFacts facts;
  facts.path = arguments.fragments[0];
  facts.format = "fragments";
  facts.fragments = arguments.fragments.size();
  facts.input_bytes = std::filesystem::file_size(facts.path);
  if (options.memory_bytes != MemoryBudget::kUnlimited) facts.memory_budget_bytes = options.memory_bytes;
  if (!arguments.quiet && glued.result) print_summary(facts, {*glued.result});
  if (!arguments.quiet && !glued.result) {
    print_line(printable(fmt::format("{} of {}, f = {}", ooc::part_names(glued.info.runs), glued.info.mesh.shares.parts,
                                     glued.info.function)));
    print_line(fmt::format("  {} and {} have settled; {} open", count_of(glued.info.settled_nodes, "node"),
                           count_of(glued.info.settled_arcs, "arc"), count_of(glued.open_vertices, "vertex")));
    print_line("  wrote " + printable(arguments.output));
  }
  if (!arguments.report.empty())
    write_output(arguments.report, options.replace,
                 [&](std::ostream& out) { out << report_json(facts, {*glued.result}); });
}

}  // namespace

void add_glue(Program& program) {
  auto arguments = std::make_shared<GlueArguments>();
  ooc::GlueOptions& options = arguments->options;
  options.threads = 0;
  options.replace = false;
  Command command = program.add_command("glue", "Join fragments of a mesh to its graph");
  command.add_option("FRAGMENT", arguments->fragments, "Files that `reeb fragment` or `reeb glue` wrote, in any order")
      .required()
      .type_name("");
  command
      .add_option("-o,--output", arguments->output,
                  "File to write: OUT.reeb, the graph, for which all parts must be there; or OUT.fragment, to be "
                  "glued again")
      .required()
      .type_name("FILE");
  command.add_flag("--graph-only", options.graph_only,
                   "Stop after the graph: no pairs, no levels (default: as in the fragments)");
  add_count(command, "--buckets", options.buckets, "0: no embedding (default: as in the fragments)",
            {.most = kMostBuckets});
  add_memory(command, options.memory_bytes);
  add_threads(command, options.threads);
  add_temp_dir(command, options.temp_dir);
  command.add_option("--report", arguments->report, "Write figures of the run as JSON; - is standard output")
      .type_name("FILE");
  add_quiet(command, arguments->quiet);
  add_force(command, options.replace);
  command.footer("Example:\n  reeb glue p1.fragment p2.fragment -o scan.reeb");
  command.callback([arguments] { run_glue(*arguments); });
}

}  // namespace reeb::tools
