// `reeb extract`: one level of a .reeb file, as text or lines in space.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "io/export/graph_export.h"
#include "io/file/atomic_file.h"
#include "io/file/file.h"
#include "io/file/file_name.h"
#include "io/file/file_ostream.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/measures/measured_level.h"
#include "tools/measures/open_segmentation.h"
#include "tools/plot/chosen_level.h"
#include "tools/plot/skeleton.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/whole_levels.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

struct ExtractOptions {
  std::string file, output = io::kStandardOutput, format, mesh, temp_folder;
  LevelChoice level;
  std::optional<std::uint64_t> memory_bytes;
  io::ImageOptions image;  // of the mesh
  unsigned threads = 0;
  bool on_surface = false, force = false, quiet = false;
};

// Chooses by --format, or else by the ending of the output's name; rg on standard output.
io::GraphFormat choose_format(const ExtractOptions& options) {
  std::string name = options.format;
  if (name.empty() && options.output == io::kStandardOutput) name = "rg";
  if (!name.empty()) {
    if (const auto format = io::graph_format(name)) return *format;
    throw Error(ErrorKind::kUsage, "--format: \"" + name + "\" is not a format for graphs",
                "use one of: " + io::graph_format_names());
  }
  const std::string suffix = io::name_suffix(options.output);
  if (const auto format = io::graph_format(suffix.empty() ? suffix : suffix.substr(1))) return *format;
  throw Error(ErrorKind::kUsage, "cannot tell the format of the graph from this name",
              "end the name in .json, .vtp, ..., or use --format with one of: " + io::graph_format_names())
      .at(options.output);
}

std::uint32_t choose_version(const ooc::ReebFile& file, const ExtractOptions& options) {
  if (options.memory_bytes) return file.finest_with_memory(*options.memory_bytes);
  return choose_level(file, options.level).version;
}

// THROWS: Error{kUsage} for a format that has no room for the measures.
void require_measured_format(io::GraphFormat format) {
  using enum io::GraphFormat;
  if (format != kJson && format != kVtp && format != kVtu)
    throw Error(ErrorKind::kUsage, "--mesh: only json, vtp and vtu say what is measured on a mesh",
                "use --format json, or leave --mesh out");
}

// Standard output and devices get the tables of CSV one after the other, a file g.csv becomes two files.
std::vector<std::string> output_files(io::GraphFormat format, const std::string& output) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(output, ignored).type();
  using Type = std::filesystem::file_type;
  const bool is_device = kind == Type::character || kind == Type::fifo || kind == Type::socket;
  if (format != io::GraphFormat::kCsv || output == io::kStandardOutput || is_device) return {output};
  const std::size_t suffix = io::name_suffix(output) == ".csv" ? 4 : 0;
  const std::string stem = output.substr(0, output.size() - suffix);
  return {stem + ".nodes.csv", stem + ".arcs.csv"};
}

// Neither file gets its name before both are whole. Both stay, or neither. If another program took a name meanwhile,
// that table stays under another one.
void write_tables(const io::GraphView& view, const std::string& nodes, const std::string& arcs, bool force) {
  io::AtomicFile node_file(nodes, {.existing = late_outputs(force)});
  io::AtomicFile arc_file(arcs, {.existing = late_outputs(force)});
  io::FileOstream node_table(node_file.out()), arc_table(arc_file.out());
  io::write_csv_tables(view, node_table, arc_table);
  const bool replaces = force && std::filesystem::exists(nodes);
  std::optional<Error> node_error;  // of a table that is there all the same
  try {
    node_file.commit();
  } catch (const Error& error) {
    if (node_file.name().empty()) throw;
    node_error = error;
  }
  try {
    arc_file.commit();
  } catch (...) {
    std::error_code ignored;
    if (arc_file.name().empty() && !replaces) std::filesystem::remove(node_file.name(), ignored);
    if (arc_file.name().empty() || !node_error) throw;
    node_error =
        Error(node_error->kind(), node_error->message() + ", and the arcs are " + arc_file.name(), node_error->hint())
            .at(node_error->file());
  }
  if (node_error) throw *node_error;
}

void extract(const ExtractOptions& options) {
  const io::GraphFormat format = choose_format(options);
  if (!options.mesh.empty()) require_measured_format(format);
  if (options.mesh.empty()) refuse_image_options(options.image);
  // Errors in the command line are reported before the file is read.
  if (options.on_surface && !io::has_lines(format))
    throw Error(ErrorKind::kUsage, "--on-surface is for formats with lines in space",
                "choose one of: vtp vtu ply obj swc gltf");
  check_threshold(options.level);
  require_reeb_file(options.file, "extract");
  RunFiles files;
  const ooc::ReebFile file(options.file);
  if (options.mesh.empty())
    files.add_input(options.file, "the .reeb file");
  else
    add_segmentation_inputs(options.mesh, {}, options.image, file, files);
  const std::vector<std::string> outputs = output_files(format, options.output);
  for (const std::string& output : outputs)
    files.add_output(output, outputs.size() > 1 ? "an output" : "the output", existing_outputs(options.force));
  files.check();
  warn_of_damage(file);
  const FileFlags& flags = file.header().flags;
  if (options.on_surface) require_surface_points(file);
  if (flags.has_embedding && !flags.has_spreads && format == io::GraphFormat::kSwc)
    print_line(
        fmt::format("reeb: warning: {}: this file was written by an earlier version, which did not record radii, "
                    "so they are 0; compute the graph of the mesh again",
                    printable(options.file)));
  if (!options.quiet) note_large_threshold(file, options.level.threshold);
  ooc::Level level = read_part(file, FilePart::kLevel, [&] { return file.load(choose_version(file, options)); });
  ooc::MeasuredArcs measured;
  const std::string beside = options.output == io::kStandardOutput ? "" : options.output;
  if (!options.mesh.empty())
    measured = measure_level(
        file, level,
        {.mesh = options.mesh,
         .image = options.image,
         .temp_folder = options.temp_folder.empty() ? io::TempDir::default_folder(beside) : options.temp_folder,
         .threads = options.threads,
         .quiet = options.quiet});
  const io::GraphView view{
      level.graph,   file.header().function, level.threshold,   level.buckets.view(), file.header().bucket_exponent,
      measured.arcs, flags.has_spreads,      options.on_surface};
  if (outputs.size() == 2)
    write_tables(view, outputs[0], outputs[1], options.force);
  else
    write_output(options.output, options.force, [&](std::ostream& out) { io::write_graph(format, view, out); });
  if (options.quiet || options.output == io::kStandardOutput) return;
  print_line("wrote " + printable(outputs[0]) + (outputs.size() == 2 ? " and " + printable(outputs[1]) : ""));
}

}  // namespace

void add_extract(Program& app) {
  auto options = std::make_shared<ExtractOptions>();
  Command command = app.add_command("extract", "Write the graph, or a coarser level of it");
  command.add_option("FILE", options->file, "The .reeb file").required().type_name("");
  command
      .add_option("-o,--output", options->output,
                  "File to write (default, and -: standard output); csv: g.csv becomes g.nodes.csv and "
                  "g.arcs.csv")
      .type_name("FILE");
  command
      .add_option(
          "--format", options->format,
          "One of " + io::graph_format_names() + " (default: by the suffix of the output; rg on standard output)")
      .type_name("NAME");
  const LevelOptions level = add_level_options(command, options->level);
  Option memory =
      add_memory(command, options->memory_bytes, "The finest level that fits in this memory: 64M").option_text("SIZE");
  memory.excludes(level.threshold).excludes(level.nodes);
  Option mesh = command
                    .add_option("--mesh", options->mesh,
                                "The mesh that the file was computed from. Measures the part of it on each arc: "
                                "vertices, mean of the function, area, shortest contour (json, vtp, vtu)")
                    .type_name("MESH");
  add_image_options(command, options->image);
  add_threads(command, options->threads, "With --mesh: number of threads, 1 to 1024 (default: all)").needs(mesh);
  add_temp_dir(command, options->temp_folder,
               "With --mesh: folder for temporary files (default: $TMPDIR, or the folder of the output)")
      .needs(mesh);
  add_quiet(command, options->quiet);
  command.add_flag("--on-surface", options->on_surface,
                   "Lines pass through vertices of the mesh, not through the centres of contours");
  add_force(command, options->force);
  command.footer("Example:\n  reeb extract scan.reeb --threshold 0.1% -o coarse.json");
  command.callback([options] { extract(*options); });
}

}  // namespace reeb::tools
