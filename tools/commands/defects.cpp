// `reeb defects MESH [FILE.reeb ...]`: the small handles and tunnels of a surface, placed, measured and ranked.
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "io/file/file_name.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/printable.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/defects/defect_text.h"
#include "tools/defects/find_defects.h"
#include "tools/defects/patch_files.h"
#include "tools/defects/row_limits.h"
#include "tools/defects/surface_census.h"
#include "tools/library/run_files.h"
#include "tools/measures/open_segmentation.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/signals.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMostPatches = 20;  // that are written if nothing else is said

struct DefectsOptions {
  FindDefectsOptions find;
  std::string below, longest, output, patches;
  std::size_t limit = kNoLimit;
  bool force = false, quiet = false;
};

bool is_json(const std::string& output) { return io::name_suffix(output) == ".json"; }

void check_files(const DefectsOptions& options) {
  const std::string& mesh = options.find.mesh.path;
  require_mesh_to_reread(mesh, "name the mesh first: reeb defects MESH FILE.reeb");
  RunFiles files;
  files.add_mesh(mesh, options.find.mesh.format, options.find.mesh.image);
  for (const std::string& file : options.find.files) {
    require_reeb_file(file, "defects " + mesh);
    files.add_input(file, "a .reeb file");
    add_values_of(ooc::ReebFile(file), files);
  }
  if (options.output != io::kStandardOutput) files.add_standard_output("the table");
  if (!options.output.empty()) files.add_output(options.output, "the output", existing_outputs(options.force));
  if (!options.patches.empty()) add_patches(options.patches, existing_outputs(options.force), files);
  files.check();
  if (!options.patches.empty()) check_patch_folder(options.patches, existing_outputs(options.force));
}

void run_defects(DefectsOptions options) {
  const RowLimits limits = parse_row_limits(options.below, options.longest);
  check_files(options);
  if (options.find.mesh.temp_folder.empty())
    options.find.mesh.temp_folder =
        io::TempDir::default_folder(options.output == io::kStandardOutput ? "" : options.output);
  ProgressBar bar(options.quiet);
  options.find.mesh.interrupted = watch_signals();
  options.find.computing = [&](const ComputeProgress& p) {
    bar.update({"Reeb graphs", 1}, p.done, p.total, p.triangles);
  };
  options.find.searching = [&](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
    bar.update({"curves"}, done, total, triangles);
  };
  const Defects defects = find_defects(options.find);
  options.find.mesh.check_interruption();
  options.find.mesh.interrupted = {};  // from now on, a signal leaves nothing behind
  bar.clear();
  if (!options.quiet && !defects.note.empty()) print_line("note: " + defects.note);
  std::vector<RankedRow> rows;
  for (std::size_t i = 0; i < defects.table.rows.size() && rows.size() < options.limit; ++i)
    if (const DefectRow& row = defects.table.rows[i]; limits.has_persistence(row) && limits.has_length(row))
      rows.push_back({i + 1, &row});
  if (options.output != io::kStandardOutput) fmt::print("{}", defect_table(defects, rows));
  if (!options.patches.empty()) {
    const std::size_t most = options.limit == kNoLimit ? kMostPatches : rows.size();
    const ValuedMesh mesh(options.find.mesh, defects.functions);
    const auto drawn = std::span(rows).first(std::min(rows.size(), most));
    write_patches(mesh, defects, drawn, options.patches, existing_outputs(options.force));
    if (!options.quiet)
      print_line(fmt::format("wrote {}: surfaces and curves of {}", printable(options.patches),
                             count_of(drawn.size(), "loop")));
  }
  if (options.output.empty()) return;
  write_output(options.output, options.force, [&](std::ostream& out) {
    if (is_json(options.output))
      write_defect_json(defects, rows, census_of(options.find.mesh), out);
    else
      write_defect_csv(defects, rows, out);
  });
  if (options.quiet || options.output == io::kStandardOutput) return;
  note_other_suffix(options.output, {".csv", ".json"}, "a table in CSV");
  print_line("wrote " + printable(options.output));
}

}  // namespace

void add_defects(Program& program) {
  auto options = std::make_shared<DefectsOptions>();
  Command command = program.add_command("defects", "List small handles and tunnels of a surface, ranked");
  command.add_option("MESH", options->find.mesh.path, "Mesh of any format, also as .gz and .zst")
      .required()
      .type_name("");
  command
      .add_option("FILE", options->find.files,
                  "Reeb graphs of the mesh; the first one has the loops, the others offer shorter curves (default: "
                  "those of x, y and z are computed)")
      .type_name("");
  command.add_option("-o,--output", options->output, "File to write: .csv or .json; - is CSV at standard output")
      .type_name("FILE");
  command.add_option("--below", options->below, "Only loops of less persistence: 0.01, or 0.1% of the function's range")
      .type_name("T");
  command.add_option("--longest", options->longest, "Only loops with a curve of at most this length")
      .type_name("LENGTH");
  command
      .add_option("--patches", options->patches,
                  "Write each row's surface and curves to DIR as PLY (first 20 rows, unless --limit)")
      .type_name("DIR");
  add_count(command, "--limit", options->limit, "At most N rows", {.least = 1});
  add_format(command, options->find.mesh.format);
  add_image_options(command, options->find.mesh.image);
  add_memory(command, options->find.mesh.memory_bytes);
  add_threads(command, options->find.threads);
  add_temp_dir(command, options->find.mesh.temp_folder);
  add_force(command, options->force);
  add_quiet(command, options->quiet);
  command.footer("Example:\n  reeb defects scan.ply --limit 20 -o scan-defects.csv");
  command.callback([options] { run_defects(*options); });
}

}  // namespace reeb::tools
