// `reeb info`: the contents of a file, a graph or a mesh.
#include <memory>
#include <string>

#include "libreeb/base/memory_budget.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/meshes/mesh_info.h"
#include "tools/runs/fragment_info.h"
#include "tools/runs/reeb_info.h"

namespace reeb::tools {
namespace {

struct InfoOptions {
  std::string file, format, temp_folder;
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  io::ImageOptions image;
  bool json = false;
};

void info(const InfoOptions& options) {
  const bool may_be_graph = options.file != "-" && options.format.empty();
  const bool is_graph = may_be_graph && ooc::is_reeb_file(options.file);
  const bool is_fragment = may_be_graph && !is_graph && ooc::is_fragment(options.file);
  RunFiles files;
  if (is_graph || is_fragment)
    files.add_input(options.file, is_graph ? "the .reeb file" : "the fragment");
  else
    files.add_mesh(options.file, options.format, options.image);
  files.add_standard_output();
  files.check();
  if (is_graph)
    print_reeb_info(options.file, options.json);
  else if (is_fragment)
    print_fragment_info(options.file, options.json);
  else
    print_mesh_info(options.file, options.format, options.memory_bytes, options.temp_folder, options.json,
                    options.image);
}

}  // namespace

void add_info(Program& app) {
  auto options = std::make_shared<InfoOptions>();
  Command command = app.add_command("info", "Describe a mesh, a .reeb file or a fragment");
  command
      .add_option("FILE", options->file,
                  "A .reeb file, a fragment, or a mesh of any format; - reads a mesh from standard input")
      .required()
      .type_name("");
  add_format(command, options->format);
  add_image_options(command, options->image);
  command.add_flag("--json", options->json, "Print JSON");
  add_memory(command, options->memory_bytes, "Memory for the tables of a mesh: 64M (default: no limit)");
  add_temp_dir(command, options->temp_folder, "Folder for temporary files (default: $TMPDIR, or the current folder)");
  command.footer("Example:\n  reeb info scan.reeb");
  command.callback([options] { info(*options); });
}

}  // namespace reeb::tools
