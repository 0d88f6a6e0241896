// `reeb verify`: whether a .reeb file is whole and contradicts neither itself nor its mesh.
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>

#include "io/formats/open_mesh.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/whole_mesh/mesh_recount.h"
#include "ooc/whole_mesh/workspace.h"
#include "tools/commands/commands.h"
#include "tools/program/node_check.h"
#include "tools/program/quantity.h"

namespace reeb::tools {
namespace {

struct VerifyOptions {
  std::string file, mesh, memory, temp_folder;
};

template <class Count>
void compare(const std::string& path, const char* what, Count in_file, Count in_mesh) {
  if (in_file == in_mesh) return;
  throw Error(ErrorKind::kBadInput, fmt::format("the file says {} {}, the mesh has {}", in_file, what, in_mesh),
              "name the mesh that the file was computed from")
      .at(path);
}

std::string describe_surface(const ooc::MeshRecount& mesh) {
  if (!mesh.most_loops) return "not a surface, so its loops are not bounded";
  if (!mesh.closed) return fmt::format("a surface with boundary: at most {} loops", *mesh.most_loops);
  return fmt::format("a closed surface of genus {}", *mesh.most_loops);
}

void compare_with_mesh(const ooc::ReebFile& file, const VerifyOptions& options) {
  const std::uint64_t memory = options.memory.empty() ? MemoryBudget::kUnlimited : parse_size(options.memory);
  ooc::Workspace space(options.temp_folder, memory);
  const FileHeader& header = file.header();
  const ReebGraph graph = file.load(0).graph;
  NodeCheck nodes(options.mesh, header.function, graph);
  const auto reader = io::open_mesh(options.mesh, {.properties = nodes.properties()});
  nodes.start(reader->info());
  const ooc::MeshRecount mesh =
      ooc::recount_mesh(*reader, space, [&nodes](const MeshBatch& batch) { nodes.add(batch); });
  const std::optional<ValueRange> range = nodes.finish();
  compare(options.file, "vertices", header.mesh_vertices, mesh.vertices);
  compare(options.file, "triangles", header.mesh_triangles, mesh.triangles);
  compare(options.file, "components", header.components, mesh.components);
  if (range) {
    compare(options.file, "as the least value", header.function_min, range->min);
    compare(options.file, "as the greatest value", header.function_max, range->max);
  }
  if (mesh.most_loops && header.loops > *mesh.most_loops)
    throw Error(ErrorKind::kBadInput,
                fmt::format("there are {} loops, but the mesh is {}", header.loops, describe_surface(mesh)),
                "name the mesh that the file was computed from")
        .at(options.file);
  fmt::print("{}: good: {} components, Euler characteristic {}, {}\n", options.mesh, mesh.components, mesh.euler,
             describe_surface(mesh));
}

void verify(const VerifyOptions& options) {
  const ooc::ReebFile file(options.file);
  file.verify();
  const FileHeader& header = file.header();
  fmt::print("{}: good: {} nodes, {} arcs, {} components, {} loops, {} pairs, {} versions\n", options.file,
             header.nodes, header.arcs, header.components, header.loops, header.pairs, std::uint64_t{header.steps} + 1);
  if (!options.mesh.empty()) compare_with_mesh(file, options);
}

}  // namespace

void add_verify(CLI::App& app) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command = app.add_subcommand("verify", "Check a .reeb file: checksums, structure, counts");
  command->add_option("FILE", options->file, "The .reeb file")->required();
  command->add_option("--mesh", options->mesh, "The mesh that it was computed from, to count again independently");
  command->add_option("--memory", options->memory, "Memory for the tables of the mesh, as 64M");
  command->add_option("--temp-dir", options->temp_folder,
                      "Folder for temporary files (default: $TMPDIR, or the current folder)");
  command->footer("Example:\n  reeb verify scan.reeb --mesh scan.ply");
  command->callback([options] { verify(*options); });
}

}  // namespace reeb::tools
