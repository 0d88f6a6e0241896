// `reeb plot`: pictures of a .reeb file.
#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/measures/open_segmentation.h"
#include "tools/plot/charts.h"
#include "tools/plot/picture_file.h"
#include "tools/plot/skeleton.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/whole_levels.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

struct PlotOptions {
  std::vector<std::string> files;
  std::string output, kind = "loops";
  std::string view, surface, color = "value";  // no surface: solid, if there is a mesh
  SkeletonOptions skeleton;
  bool force = false, quiet = false;
};

// "X,Y,Z". THROWS: Error{kUsage}.
Point parse_view(const std::string& text) {
  Point direction{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [rest, error] = std::from_chars(at, end, direction[axis]);
    const bool ends_well = axis == 2 ? rest == end : rest != end && *rest == ',';
    if (error != std::errc() || !ends_well || !std::isfinite(direction[axis]))
      throw Error(ErrorKind::kUsage, "--view: \"" + text + "\" is not a direction",
                  "give three numbers like 1,-0.5,0.3, towards the eye");
    at = rest + (axis == 2 ? 0 : 1);
  }
  if (direction == Point{})
    throw Error(ErrorKind::kUsage, "--view: 0,0,0 is not a direction", "give three numbers like 1,-0.5,0.3");
  return direction;
}

// What only some kinds of pictures have. THROWS: Error{kUsage}.
void check_kind(const PlotOptions& options) {
  if (options.files.size() > 1 && options.kind != "loops")
    throw Error(ErrorKind::kUsage, "--kind " + options.kind + " draws one file", "name one file, or use --kind loops");
  if (options.kind == "skeleton") {
    if (!options.surface.empty() && options.skeleton.mesh.empty())
      throw Error(ErrorKind::kUsage, "--surface needs --mesh MESH", "name the mesh, or leave --surface out");
    return;
  }
  for (const auto& [name, is_given] :
       {std::pair("--mesh", !options.skeleton.mesh.empty()), std::pair("--view", !options.view.empty()),
        std::pair("--surface", !options.surface.empty()), std::pair("--color", options.color != "value"),
        std::pair("--on-surface", options.skeleton.on_surface)})
    if (is_given) throw Error(ErrorKind::kUsage, std::string(name) + " is for --kind skeleton", "add --kind skeleton");
}

SkeletonOptions skeleton_options(const PlotOptions& options, const std::string& temp_folder, ProgressBar& bar) {
  SkeletonOptions skeleton = options.skeleton;
  skeleton.temp_folder = temp_folder;
  if (!options.view.empty()) skeleton.view = parse_view(options.view);
  using Style = io::SurfaceStyle;
  skeleton.surface = options.surface == "glass"   ? Style::kGlass
                     : options.surface == "value" ? Style::kValue
                     : options.surface == "none"  ? Style::kNone
                                                  : Style::kSolid;
  if (options.color == "arcs") skeleton.colors = io::LineColors::kArcs;
  skeleton.progress = [&bar](const char* pass, std::uint64_t done, std::uint64_t total) {
    bar.update({pass}, done, total);
  };
  return skeleton;
}

std::string draw(const PlotOptions& options, std::span<const ooc::ReebFile> files, const std::string& temp_folder) {
  if (options.kind == "loops") return draw_loops(files, options.skeleton.level, temp_folder);
  if (options.kind == "diagram") return draw_diagram(files[0], options.skeleton.level, temp_folder);
  if (options.kind == "graph") return draw_graph(files[0], options.skeleton.level, temp_folder);
  ProgressBar bar(options.quiet);
  return draw_skeleton(files[0], skeleton_options(options, temp_folder, bar));
}

// Says of files that were cut what can be drawn.
std::string draw_whole(const PlotOptions& options, std::span<const ooc::ReebFile> files,
                       const std::string& temp_folder) {
  const bool draws_pairs = options.kind == "loops" || options.kind == "diagram";
  try {
    return draw(options, files, temp_folder);
  } catch (const Error& error) {
    for (const ooc::ReebFile& file : files)
      if (meets_missing_part(file, error))
        throw with_whole_level(file, error, draws_pairs ? FilePart::kPairs : FilePart::kLevel);
    throw;
  }
}

void plot(PlotOptions options) {
  if (options.output.empty()) options.output = std::filesystem::path(options.files[0]).stem().string() + ".svg";
  const PictureFormat format = picture_format(options.output);
  check_kind(options);
  if (options.skeleton.mesh.empty()) refuse_image_options(options.skeleton.image);
  if (!options.view.empty()) parse_view(options.view);
  check_threshold(options.skeleton.level);
  if (options.skeleton.mesh == "-")
    throw Error(ErrorKind::kUsage, "the mesh must be read twice, and standard input can be read once",
                "name a file with --mesh");
  RunFiles names;
  for (const std::string& file : options.files) {
    require_reeb_file(file, "plot");
    names.add_input(file, "the .reeb file");
  }
  if (!options.skeleton.mesh.empty()) {
    require_mesh_file(options.skeleton.mesh, "name its mesh with --mesh");
    names.add_mesh(options.skeleton.mesh, options.skeleton.format, options.skeleton.image);
    if (options.surface == "value") add_values_of(ooc::ReebFile(options.files[0]), names);
  }
  names.add_output(options.output, "the picture", existing_outputs(options.force));
  names.check();
  require_programs(format);
  std::vector<ooc::ReebFile> files;
  for (const std::string& file : options.files) {
    files.emplace_back(file);
    warn_of_damage(files.back());
    if (!options.quiet) note_large_threshold(files.back(), options.skeleton.level.threshold);
  }
  const std::string temp_folder = io::TempDir::default_folder(options.output);
  const std::string bytes = picture_bytes(draw_whole(options, files, temp_folder), format, temp_folder);
  write_output(options.output, options.force, [&](std::ostream& out) { out << bytes; });
  if (!options.quiet && options.output != io::kStandardOutput) print_line("wrote " + printable(options.output));
}

}  // namespace

void add_plot(Program& program) {
  auto options = std::make_shared<PlotOptions>();
  Command command = program.add_command("plot", "Draw loops, pairs, the graph, or its skeleton");
  command.add_option("FILE", options->files, "The .reeb file; several with --kind loops").required().type_name("");
  command
      .add_option("-o,--output", options->output,
                  "Picture to write: .svg, .png or .pdf (default: the name of the file with .svg, in the current "
                  "folder); - writes SVG to standard output")
      .type_name("FILE");
  command.add_option("--kind", options->kind, "What to draw: loops, diagram, graph or skeleton (default: loops)")
      .one_of({"loops", "diagram", "graph", "skeleton"})
      .type_name("KIND");
  add_level_options(command, options->skeleton.level);
  command.add_option("--mesh", options->skeleton.mesh, "For a skeleton: its mesh, drawn behind it").type_name("MESH");
  add_format(command, options->skeleton.format);
  add_image_options(command, options->skeleton.image);
  command
      .add_option("--view", options->view,
                  "For a skeleton: the direction from the shape to the eye (default: the best of several)")
      .option_text("X,Y,Z");
  command
      .add_option("--surface", options->surface,
                  "With --mesh: solid, glass, value (coloured by the function) or none (default: solid)")
      .one_of({"solid", "glass", "value", "none"})
      .type_name("STYLE");
  command
      .add_option("--color", options->color,
                  "For a skeleton: by value, or a colour for each of the arcs (default: value)")
      .one_of({"value", "arcs"})
      .type_name("BY");
  command.add_flag("--on-surface", options->skeleton.on_surface,
                   "For a skeleton: lines pass through vertices of the mesh");
  add_force(command, options->force);
  add_quiet(command, options->quiet);
  command.footer("Example:\n  reeb plot scan.reeb --kind skeleton --mesh scan.ply --threshold 1% -o scan.png");
  command.callback([options] { plot(*options); });
}

}  // namespace reeb::tools
