// `reeb convert IN OUT`: between all mesh formats, with finalization and in other orders.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "io/file/temp_dir.h"
#include "io/formats/create_mesh.h"
#include "libreeb/base/printable.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/meshes/convert_mesh.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

struct ConvertArguments {
  std::string order = "keep";
  ConvertOptions options;
  bool force = false, quiet = false;
};

void run_convert(ConvertArguments arguments) {
  ConvertOptions& options = arguments.options;
  options.order = parse_order(arguments.order);
  if (options.temp_folder.empty()) options.temp_folder = io::TempDir::default_folder(options.output);
  io::check_mesh_name(options.output);
  options.existing = late_outputs(arguments.force);
  RunFiles files;
  files.add_mesh(options.input, options.format, options.image);
  if (options.order.function) files.add_values_of(*options.order.function);
  files.add_output(options.output, "the output", existing_outputs(arguments.force), "for OUT");
  files.check();
  ProgressBar bar(arguments.quiet);
  const auto notes = convert_mesh(options, bar);
  bar.clear();
  if (arguments.quiet) return;
  for (const std::string& note : notes) print_line("note: " + printable(note));
  print_line("wrote " + printable(options.output));
}

}  // namespace

void add_convert(Program& program) {
  auto arguments = std::make_shared<ConvertArguments>();
  ConvertOptions& options = arguments->options;
  Command command = program.add_command("convert", "Convert a mesh into another format or order");
  command.add_option("IN", options.input, "Mesh of any format, also as .gz and .zst; - reads standard input")
      .required()
      .type_name("");
  command
      .add_option(
          "OUT", options.output,
          "Mesh to write: .ply .obj .off .cx .sma .smb .smc .sva .svb; .events.txt lists the events; not IN itself")
      .required()
      .type_name("");
  for (const char* name : {"-o", "--output"})
    command.refuse_option(name, "reeb convert has no such option",
                          "the output is the second argument: reeb convert IN OUT");
  add_format(command, options.format, "Format of IN");
  command
      .add_option("--order", arguments->order,
                  "Order of the triangles: keep, hilbert, spectral or sweep:FUNC (default: keep)")
      .type_name("ORDER");
  command.add_flag("--finalize", options.finalize,
                   "Put each vertex before its first triangle, and finalize it after its last");
  add_image_options(command, arguments->options.image);
  add_memory(command, options.memory_bytes);
  add_temp_dir(command, options.temp_folder);
  add_force(command, arguments->force);
  add_quiet(command, arguments->quiet);
  command.footer("Example:\n  reeb convert scan.ply scan.smc --order spectral --memory 256M");
  command.callback([arguments] { run_convert(*arguments); });
}

}  // namespace reeb::tools
