// `reeb verify`: whether a .reeb file is whole and contradicts neither itself nor its mesh.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/formats/open_input.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "libreeb/format/mesh_match.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/whole_mesh/mesh_recount.h"
#include "ooc/whole_mesh/workspace.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/checks/full_check.h"
#include "tools/checks/node_check.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/measures/open_segmentation.h"
#include "tools/program/input_kind.h"
#include "tools/program/progress.h"
#include "tools/program/signals.h"

namespace reeb::tools {
namespace {

struct VerifyOptions {
  std::string file, mesh, format, temp_folder;
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  unsigned threads = 0;
  io::ImageOptions image;
  bool full = false;
};

template <class Count>
void compare(const std::string& path, const char* what, Count in_file, Count in_mesh) {
  if (in_file == in_mesh) return;
  throw Error(ErrorKind::kBadInput, fmt::format("the file says {} {}, the mesh has {}", in_file, what, in_mesh),
              "name the mesh that the file was computed from")
      .at(path);
}

std::string describe_surface(const ooc::MeshRecount& mesh) {
  if (!mesh.most_loops) return "not a 2-manifold, so the genus is undefined and the loops are not bounded";
  return fmt::format("a {}: at most {}", mesh.closed ? "closed surface" : "surface with boundary",
                     count_of(*mesh.most_loops, "loop"));
}

// Returns what cannot be checked with this mesh; else empty.
std::string compare_with_mesh(const ooc::ReebFile& file, const VerifyOptions& options) {
  ooc::Workspace space(options.temp_folder, options.memory_bytes);
  const FileHeader& header = file.header();
  const ReebGraph graph = file.load(0).graph;
  NodeCheck nodes(options.file, options.mesh, header.function, graph);
  if (const std::string missing = nodes.missing_file(); options.full && !missing.empty())
    throw Error(ErrorKind::kBadInput, "there is no such file, and --full needs the values of the function",
                "bring the file of values back, or leave out --full")
        .at(missing);
  const io::Input input = io::mesh_input(options.mesh, options.format);
  bool has_cells = false;
  ProgressBar bar(false);
  const ooc::MeshRecount mesh = input.read([&] {
    const auto reader =
        io::open_mesh(input, input.open(), {.properties = nodes.properties()}, options.image, options.format);
    io::OpenMesh open_again;
    if (io::is_regular_file(options.mesh))
      open_again = [&] { return io::open_mesh(input, input.open(), {}, options.image, options.format); };
    nodes.start(reader->info(), open_again, options.temp_folder, options.memory_bytes);
    std::uint64_t simplices = 0;
    return ooc::recount_mesh(*reader, space, [&](const MeshBatch& batch) {
      nodes.add(batch);
      has_cells = has_cells || batch.has_cells();
      simplices += batch.simplex_count();
      bar.update({"counting"}, reader->bytes_read(), reader->info().file_bytes, simplices);
    });
  });
  bar.clear();
  require_same_mesh(options.file, {header.mesh_vertices, header.mesh_triangles}, {mesh.vertices, mesh.triangles});
  const std::optional<ValueRange> range = nodes.finish();
  compare(options.file, "components", with_commas(header.components), with_commas(mesh.components));
  if (range) {
    compare(options.file, "as the least value", header.function_min, range->min);
    compare(options.file, "as the greatest value", header.function_max, range->max);
  }
  if (mesh.most_loops && header.loops > *mesh.most_loops)
    throw Error(ErrorKind::kBadInput,
                fmt::format("it has {}, but the mesh is {}", count_of(header.loops, "loop"), describe_surface(mesh)),
                "name the mesh that the file was computed from")
        .at(options.file);
  fmt::print("{}: OK: {}, Euler characteristic {}{}, {}\n", printable(options.mesh),
             count_of(mesh.components, "component"), has_cells ? "of the 2-skeleton " : "", mesh.euler,
             describe_surface(mesh));
  if (!nodes.unchecked().empty()) return nodes.unchecked();
  // A run without the memory for the last pass of noise removal leaves what the first stage has not removed.
  if (header.denoise_threshold == 0 && header.denoised_pairs != 0 && options.full)
    return "noise was removed in part, so the graph was not computed again";
  return {};
}

void compute_again(const ooc::ReebFile& file, const VerifyOptions& options) {
  check_fully(file, {.mesh = options.mesh,
                     .format = options.format,
                     .temp_folder = options.temp_folder,
                     .memory_bytes = options.memory_bytes,
                     .threads = options.threads,
                     .image = options.image,
                     .interrupted = watch_signals()});
  const FileHeader& header = file.header();
  fmt::print("{}: OK: computed again, it has the same {}, {} and {}\n", printable(options.mesh),
             count_of(header.nodes, "node"), count_of(header.arcs, "arc"), count_of(header.pairs, "pair"));
}

// What is printed may be appended to a file.
void check_files(const ooc::ReebFile& file, const VerifyOptions& options) {
  RunFiles files;
  if (options.mesh.empty())
    files.add_input(options.file, "the .reeb file");
  else
    add_segmentation_inputs(options.mesh, options.format, options.image, file, files);
  files.add_standard_output();
  files.check();
}

void verify(const VerifyOptions& options) {
  std::error_code ignored;
  const auto is_pipe = [&](const std::string& mesh) {
    return mesh == "-" || (std::filesystem::exists(mesh, ignored) && !io::is_regular_file(mesh));
  };
  if (options.full && (options.mesh.empty() || is_pipe(options.mesh)))
    throw Error(ErrorKind::kUsage, "--full needs a mesh in a file", "name it with --mesh MESH");
  if (options.mesh.empty()) refuse_image_options(options.image);
  require_reeb_file(options.file, "verify");
  require_mesh_file(options.mesh, "name the mesh that the file was computed from");
  const ooc::ReebFile file(options.file);
  check_files(file, options);
  file.verify();
  const FileHeader& header = file.header();
  fmt::print("{}: OK: {}, {}, {}, {}, {}, {}\n", printable(options.file), count_of(header.nodes, "node"),
             count_of(header.arcs, "arc"), count_of(header.components, "component"), count_of(header.loops, "loop"),
             count_of(header.pairs, "pair"), count_of(std::uint64_t{header.steps} + 1, "version"));
  if (options.mesh.empty()) return;
  const std::string unchecked = compare_with_mesh(file, options);
  if (!unchecked.empty()) fmt::print("{}: note: {}\n", printable(options.file), unchecked);
  if (options.full && unchecked.empty()) compute_again(file, options);
}

}  // namespace

void add_verify(Program& app) {
  auto options = std::make_shared<VerifyOptions>();
  Command command = app.add_command("verify", "Check a .reeb file: checksums, structure, counts");
  command.add_option("FILE", options->file, "The .reeb file").required().type_name("");
  command.add_option("--mesh", options->mesh, "The mesh that it was computed from, to count again independently")
      .type_name("MESH");
  add_format(command, options->format);
  command.add_flag("--full", options->full, "Compute the graph again from the mesh; compare nodes, arcs and pairs");
  add_image_options(command, options->image);
  add_memory(command, options->memory_bytes,
             "Memory for the tables of the mesh and for --full: 64M (default: no limit)");
  add_threads(command, options->threads, "Number of threads for --full, 1 to 1024 (default: all)");
  add_temp_dir(command, options->temp_folder, "Folder for temporary files (default: $TMPDIR, or the current folder)");
  command.footer("Example:\n  reeb verify scan.reeb --mesh scan.ply");
  command.callback([options] { verify(*options); });
}

}  // namespace reeb::tools
