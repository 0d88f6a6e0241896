// `reeb convert IN OUT`: between all mesh formats, with finalization and in other orders.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "io/file/atomic_file.h"
#include "io/file/temp_dir.h"
#include "io/formats/create_mesh.h"
#include "libreeb/base/error.h"
#include "tools/commands/commands.h"
#include "tools/program/convert_mesh.h"
#include "tools/program/quantity.h"

namespace reeb::tools {
namespace {

struct ConvertArguments {
  std::string order = "keep", memory;
  ConvertOptions options;
  bool force = false, quiet = false;
};

void run_convert(ConvertArguments arguments) {
  ConvertOptions& options = arguments.options;
  options.order = parse_order(arguments.order);
  if (!arguments.memory.empty()) options.memory_bytes = parse_size(arguments.memory);
  if (options.temp_folder.empty()) options.temp_folder = io::TempDir::default_folder(options.output);
  if (arguments.force) options.existing = io::Existing::kReplace;
  io::check_output_name(options.output, options.existing);
  const auto notes = convert_mesh(options);
  if (arguments.quiet) return;
  for (const std::string& note : notes) fmt::print(stderr, "reeb: note: {}\n", note);
  fmt::print(stderr, "wrote {}\n", options.output);
}

}  // namespace

void add_convert(CLI::App& program) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = program.add_subcommand("convert", "Convert a mesh into another format or order");
  command->add_option("IN", arguments->options.input, "Mesh of any format, also .gz and .zst; - reads standard input")
      ->required();
  command
      ->add_option("OUT", arguments->options.output,
                   "Mesh to write: .ply .obj .off .sma .smb .smc .sva .svb; .events.txt lists the events")
      ->required();
  command->add_flag("--finalize", arguments->options.finalize,
                    "Put each vertex before its first triangle and finalize it after its last");
  command->add_option("--order", arguments->order, "keep, hilbert, spectral or sweep:FUNC")->capture_default_str();
  command->add_option("--memory", arguments->memory, "Memory that the run may use, as 64M or 1.5GiB");
  command->add_option("--temp-dir", arguments->options.temp_folder,
                      "Folder for temporary files (default: $TMPDIR, or the output's folder)");
  command->add_flag("--force", arguments->force, "Replace an existing output");
  command->add_flag("--quiet", arguments->quiet, "No notes");
  command->footer("Example:\n  reeb convert scan.ply scan.smc --order spectral --memory 256M");
  command->callback([arguments] { run_convert(*arguments); });
}

}  // namespace reeb::tools
