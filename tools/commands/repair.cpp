// `reeb repair MESH -o OUT`: cuts handles and fills tunnels; and takes that back.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/file/file_name.h"
#include "io/file/temp_dir.h"
#include "io/functions/function_spec.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/quantity.h"
#include "tools/program/signals.h"
#include "tools/program/wrapping.h"
#include "tools/repair/repair_mesh.h"
#include "tools/repair/write_repaired.h"

namespace reeb::tools {
namespace {

struct RepairArguments {
  RepairOptions options;
  std::string loops, below, longest, log, undo, apply_undo, drop_components, fill_boundaries;
  bool force = false, quiet = false;
};

void parse(RepairArguments& arguments) {
  arguments.options.filter.limits = parse_row_limits(arguments.below, arguments.longest);
  CleaningOptions& cleaning = arguments.options.cleaning;
  if (!arguments.fill_boundaries.empty())
    cleaning.boundary_length = parse_length("--fill-boundaries", arguments.fill_boundaries);
  if (arguments.drop_components.empty()) return;
  cleaning.components_percent = parse_share("--drop-components", arguments.drop_components,
                                            "give it as 1%, of the triangles of the largest component");
}

// The rows of --loops are read here, since they say which values the run reads.
void take_files(RepairArguments& arguments) {
  RepairOptions& options = arguments.options;
  require_mesh_to_reread(options.mesh.path, "name the mesh");
  const std::string suffix = io::name_suffix(options.output);
  // Other formats number vertices in another way, or hold float32 only.
  if (suffix != ".ply" && suffix != ".obj" && suffix != ".off")
    throw Error(ErrorKind::kUsage, "a repaired mesh is written as PLY, OBJ or OFF",
                "end the name of the output in .ply, .obj or .off")
        .at(options.output);
  RunFiles files;
  files.add_mesh(options.mesh.path, options.mesh.format, options.mesh.image);
  if (!arguments.loops.empty()) {
    files.add_input(arguments.loops, "the table of loops");
    options.filter.named = read_named_rows(arguments.loops);
    for (const std::string& function : options.filter.named->functions)
      files.add_values_of(io::parse_function(function));
  }
  if (!arguments.apply_undo.empty()) files.add_input(arguments.apply_undo, "the undo file");
  const io::Existing existing = existing_outputs(arguments.force);
  files.add_output(options.output, "the output", existing);
  if (!arguments.log.empty()) files.add_output(arguments.log, "the log", existing, "with --log FILE");
  if (!arguments.undo.empty()) files.add_output(arguments.undo, "the undo file", existing, "with --undo FILE");
  files.check();
}

nlohmann::ordered_json log_of(const Repair& repair) {
  nlohmann::ordered_json json = {{"schema", "reeb.repair.v1"}, {"repaired", repair.repaired}};
  auto loops = nlohmann::ordered_json::array(), left = nlohmann::ordered_json::array();
  for (const RepairedRow& row : repair.rows) {
    if (row.done)
      loops.push_back({{"rank", row.rank},
                       {"kind", name_of(row.kind)},
                       {"length", row.length},
                       {"triangles_removed", row.removed},
                       {"triangles_added", row.added},
                       {"volume", row.volume}});
    else
      left.push_back({{"rank", row.rank}, {"why", row.why}});
  }
  json["loops"] = std::move(loops);
  json["left"] = std::move(left);
  const CleaningOptions& cleaning = repair.cleaning;
  if (cleaning.degenerate) json["degenerate_dropped"] = repair.degenerate;
  if (cleaning.duplicates) json["duplicates_dropped"] = repair.duplicates;
  if (cleaning.components_percent) json["components_dropped"] = repair.components;
  if (cleaning.boundary_length) {
    json["boundaries_filled"] = repair.boundaries_filled;
    json["boundaries_left"] = repair.boundaries_left;
  }
  return json;
}

void apply_undo(const RepairArguments& arguments) {
  const RepairOptions& options = arguments.options;
  MemoryBudget budget(options.mesh.memory_bytes);
  const UndoRecord undo = read_undo(arguments.apply_undo, budget);
  ProgressBar bar(arguments.quiet);
  WriteOptions write{options.output, late_outputs(arguments.force), false, {}};
  write.progress = [&](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
    bar.update({"writing"}, done, total, triangles);
  };
  const Written written = write_undone(options.mesh, undo, write);
  bar.clear();
  if (arguments.quiet) return;
  for (const std::string& warning : written.warnings) print_line("note: " + printable(warning));
  print_line(fmt::format("{} put back, {} removed", count_of(undo.removed.size(), "triangle"),
                         count_of(undo.new_triangles, "new triangle")));
  print_line("wrote " + printable(options.output));
}

void run_repair(RepairArguments arguments) {
  RepairOptions& options = arguments.options;
  parse(arguments);
  take_files(arguments);
  if (options.mesh.temp_folder.empty()) options.mesh.temp_folder = io::TempDir::default_folder(options.output);
  if (!arguments.apply_undo.empty()) return apply_undo(arguments);
  ProgressBar bar(arguments.quiet);
  options.mesh.interrupted = watch_signals();
  options.progress = [&](const char* pass, std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
    bar.update({pass}, done, total, triangles);
  };
  const Repair repair = plan_repair(options);
  options.mesh.check_interruption();
  options.mesh.interrupted = {};  // from now on, a signal leaves nothing behind
  WriteOptions write{options.output, late_outputs(arguments.force), !arguments.undo.empty(), {}};
  write.progress = [&](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
    bar.update({"writing"}, done, total, triangles);
  };
  // The output is the last to appear: whoever has it has what belongs to it.
  const Written written = write_repaired(
      options.mesh, repair.edits, repair.mesh_vertices, repair.mesh_triangles, write, [&](const Written& whole) {
        if (!arguments.undo.empty()) write_undo(whole.undo, arguments.undo, late_outputs(arguments.force));
        if (arguments.log.empty()) return;
        write_output(arguments.log, arguments.force, [&](std::ostream& out) {
          out << log_of(repair).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
        });
      });
  bar.clear();
  if (arguments.quiet) return;
  for (const std::string& warning : repair.warnings) print_line("note: " + printable(warning));
  for (const std::string& warning : written.warnings)
    if (std::ranges::find(repair.warnings, warning) == repair.warnings.end()) print_line("note: " + printable(warning));
  for (const std::string& line : summary_of(repair)) print_line(printable(line));
  print_line("wrote " + printable(options.output));
}

}  // namespace

void add_repair(Program& program) {
  auto arguments = std::make_shared<RepairArguments>();
  RepairOptions& options = arguments->options;
  Command command = program.add_command("repair", "Cut small handles and fill tunnels of a surface");
  command.add_option("MESH", options.mesh.path, "Mesh of any format, also as .gz and .zst").required().type_name("");
  command.add_option("-o,--output", options.output, "Mesh to write: .ply, .obj or .off").required().type_name("OUT");
  const Option choices[] = {
      command
          .add_option("--below", arguments->below, "Loops of less persistence: 0.01, or 0.1% of the function's range")
          .type_name("T"),
      command
          .add_option("--longest", arguments->longest,
                      "Loops with a curve of at most this length (default: what reeb defects suggests)")
          .type_name("LENGTH"),
      command.add_option("--loops", arguments->loops, "Only loops in a table of reeb defects, or in rows of it")
          .type_name("FILE.csv"),
      command.add_flag("--all", options.filter.all, "All loops that can be repaired, however long"),
      add_count(command, "--limit", options.limit, "The first N loops that can be repaired", {.least = 1}),
      command
          .add_option("--drop-components", arguments->drop_components,
                      "Drop components of fewer triangles than N% of the largest one")
          .type_name("N%"),
      command.add_option("--fill-boundaries", arguments->fill_boundaries, "Fill boundaries of at most this length")
          .type_name("LENGTH"),
      command.add_flag("--drop-degenerate", options.cleaning.degenerate, "Drop triangles that repeat a corner"),
      command.add_flag("--drop-duplicates", options.cleaning.duplicates, "Drop repetitions of triangles"),
      command.add_option("--log", arguments->log, "Log of what was repaired, and of what was left and why, as JSON")
          .type_name("FILE"),
      command.add_option("--undo", arguments->undo, "Write what --apply-undo needs").type_name("FILE")};
  Option undo = command.add_option("--apply-undo", arguments->apply_undo, "Undo a repair: write MESH as it was before")
                    .type_name("FILE");
  for (const Option& choice : choices) undo.excludes(choice);
  add_format(command, options.mesh.format);
  add_image_options(command, options.mesh.image);
  add_memory(command, options.mesh.memory_bytes);
  add_threads(command, options.threads);
  add_temp_dir(command, options.mesh.temp_folder);
  add_force(command, arguments->force);
  add_quiet(command, arguments->quiet);
  command.footer("Example:\n  reeb repair scan.ply -o clean.ply --log clean.json --undo clean.undo");
  command.callback([arguments] { run_repair(*arguments); });
}

}  // namespace reeb::tools
