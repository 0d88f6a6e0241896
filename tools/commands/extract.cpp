// `reeb extract`: one level of a .reeb file, as text or lines in space.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "io/export/graph_export.h"
#include "libreeb/base/error.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/commands/commands.h"
#include "tools/program/output.h"
#include "tools/program/quantity.h"

namespace reeb::tools {
namespace {

struct ExtractOptions {
  std::string file, output, format, threshold, memory;
  std::uint64_t nodes = 0;
  bool by_nodes = false, force = false;
};

// Chooses by --format, or else by the ending of the output's name; rg on standard output.
io::GraphFormat choose_format(const ExtractOptions& options) {
  std::string name = options.format;
  if (name.empty()) {
    const auto dot = options.output.find_last_of('.');
    const auto slash = options.output.find_last_of('/');
    if (dot != std::string::npos && (slash == std::string::npos || dot > slash)) name = options.output.substr(dot + 1);
    if (options.output.empty() || options.output == "-") name = "rg";
  }
  if (const auto format = io::graph_format(name)) return *format;
  throw Error(ErrorKind::kUsage, "'" + name + "' is not a format of graphs",
              "use --format with one of: " + io::graph_format_names());
}

std::uint32_t choose_version(const ooc::ReebFile& file, const ExtractOptions& options) {
  if (!options.threshold.empty()) {
    const double range = file.header().function_max - file.header().function_min;
    return file.version_at(parse_threshold(options.threshold, range));
  }
  if (!options.memory.empty()) return file.finest_with_memory(parse_size(options.memory));
  return options.by_nodes ? file.finest_with_nodes(options.nodes) : 0;
}

void extract(const ExtractOptions& options) {
  const io::GraphFormat format = choose_format(options);
  // Errors in the command line are reported before the file is read.
  if (!options.threshold.empty()) parse_threshold(options.threshold, 1);
  if (!options.memory.empty()) parse_size(options.memory);
  refuse_existing(options.output, options.force);
  const ooc::ReebFile file(options.file);
  if (const Error* damage = file.damage()) fmt::print(stderr, "reeb: warning: {}\n", damage->what());
  const ooc::Level level = file.load(choose_version(file, options));
  write_output(options.output, [&](std::ostream& out) {
    io::write_graph(
        format,
        {level.graph, file.header().function, level.threshold, level.buckets.view(), file.header().bucket_exponent},
        out);
  });
}

}  // namespace

void add_extract(CLI::App& app) {
  auto options = std::make_shared<ExtractOptions>();
  CLI::App* command = app.add_subcommand("extract", "Write the graph, or a coarser level of it");
  command->add_option("FILE", options->file, "The .reeb file")->required();
  command->add_option("-o,--output", options->output, "Output file (default: standard output)");
  command->add_option("--format", options->format, io::graph_format_names() + " (default: by suffix)");
  auto* threshold =
      command->add_option("--threshold", options->threshold,
                          "Without features of less persistence: 0.01 (function units) or 0.1% (of the range)");
  auto* memory = command->add_option("--memory", options->memory, "The finest level that fits in this memory, as 64M");
  auto* nodes = command->add_option("--nodes", options->nodes, "The finest level with at most this many nodes");
  threshold->excludes(memory)->excludes(nodes);
  memory->excludes(nodes);
  command->add_flag("--force", options->force, "Replace an existing output");
  command->footer("Example:\n  reeb extract scan.reeb --threshold 0.1% -o coarse.json");
  command->callback([options, nodes] {
    options->by_nodes = nodes->count() != 0;
    extract(*options);
  });
}

}  // namespace reeb::tools
