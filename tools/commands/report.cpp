// `reeb report`: one page about a .reeb file, for people.
#include <memory>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/printable.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/measures/open_segmentation.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/wrapping.h"
#include "tools/report/report.h"

namespace reeb::tools {
namespace {

struct PageOptions {
  ReportOptions report;
  std::string output;
  bool force = false, quiet = false;
};

void check_files(const PageOptions& options) {
  const std::string& mesh = options.report.defects.mesh.path;
  if (mesh.empty()) refuse_image_options(options.report.defects.mesh.image);
  require_reeb_file(options.report.file, "report");
  RunFiles files;
  files.add_input(options.report.file, "the .reeb file");
  if (!mesh.empty()) {
    require_mesh_to_reread(mesh, "name the mesh: reeb report FILE.reeb --mesh MESH -o OUT.html");
    files.add_mesh(mesh, options.report.defects.mesh.format, options.report.defects.mesh.image);
    add_values_of(ooc::ReebFile(options.report.file), files);
  }
  files.add_output(options.output, "the output", existing_outputs(options.force));
  files.check();
}

void run_report(PageOptions options) {
  require_pages();
  check_files(options);
  FindDefectsOptions& defects = options.report.defects;
  defects.files = {options.report.file};
  if (defects.mesh.temp_folder.empty())
    defects.mesh.temp_folder = io::TempDir::default_folder(options.output == io::kStandardOutput ? "" : options.output);
  ProgressBar bar(options.quiet);
  defects.searching = [&](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
    bar.update({"curves"}, done, total, triangles);
  };
  std::vector<std::string> notes;
  options.report.note = [&](const std::string& note) { notes.push_back(note); };
  options.report.counting = [&] { bar.update({"counting", 1}, 0, 0); };
  warn_of_damage(ooc::ReebFile(options.report.file));
  const std::string page = make_report(options.report);
  bar.clear();
  write_output(options.output, options.force, [&](std::ostream& out) { out << page; });
  if (options.quiet) return;
  for (const std::string& note : notes) print_line("note: " + note);
  if (options.output == io::kStandardOutput) return;
  note_other_suffix(options.output, {".html", ".htm", ".xhtml"}, "an HTML page");
  print_line("wrote " + printable(options.output));
}

}  // namespace

void add_report(Program& program) {
  auto options = std::make_shared<PageOptions>();
  Command command = program.add_command("report", "Write one HTML page: plots, defects, skeleton");
  FindDefectsOptions& defects = options->report.defects;
  command.add_option("FILE", options->report.file, "The .reeb file").required().type_name("");
  command.add_option("-o,--output", options->output, "File to write, an HTML page; - is standard output")
      .required()
      .type_name("FILE");
  command
      .add_option("--mesh", defects.mesh.path,
                  "The mesh of the graph: adds what is wrong with it, and its defects with close-ups")
      .type_name("MESH");
  add_count(command, "--nodes", options->report.nodes,
            "The skeleton has levels with at most N nodes (default: 2000, or what the coarsest needs)",
            {.least = 1, .most = kMostReportNodes});
  add_format(command, defects.mesh.format);
  add_image_options(command, defects.mesh.image);
  add_memory(command, defects.mesh.memory_bytes,
             "Memory that reading the mesh may use: 64M, 1.5GiB (default: no limit)");
  add_threads(command, defects.threads);
  add_temp_dir(command, defects.mesh.temp_folder);
  add_force(command, options->force);
  add_quiet(command, options->quiet);
  command.footer("Example:\n  reeb report scan.reeb --mesh scan.ply -o scan.html");
  command.callback([options] { run_report(*options); });
}

}  // namespace reeb::tools
