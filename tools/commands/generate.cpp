// `reeb generate KIND -o MESH`: test meshes of any size, streamed.
#include <fmt/core.h>

#include <map>
#include <memory>
#include <string>

#include "io/formats/create_mesh.h"
#include "io/generate/generator.h"
#include "tools/commands/commands.h"

namespace reeb::tools {
namespace {

struct GenerateArguments {
  std::string kind, order = "patches", output;
  io::GeneratorOptions mesh;
  bool force = false;
};

void print_summary(const std::string& output, const io::ExpectedTopology& t) {
  fmt::print(stderr, "wrote {}: {} vertices, {} triangles, Euler characteristic {}", output, t.vertices, t.triangles,
             t.euler_characteristic);
  if (t.genus) fmt::print(stderr, ", genus {}", *t.genus);
  if (t.boundary_loops) fmt::print(stderr, ", {} boundary loops", *t.boundary_loops);
  if (!t.genus) fmt::print(stderr, ", first Betti number {}", t.first_betti);
  fmt::print(stderr, "\n");
}

void run_generate(GenerateArguments arguments) {
  arguments.mesh.kind = io::mesh_kind(arguments.kind);
  arguments.mesh.order = io::mesh_order(arguments.order);
  const auto mesh = io::generate_mesh(arguments.mesh);
  io::MeshWriterOptions options;
  options.dimension = mesh->info().dimension;
  options.vertex_count = mesh->info().vertex_count;
  options.existing = arguments.force ? io::Existing::kReplace : io::Existing::kRefuse;
  const auto writer = io::create_mesh(arguments.output, options);
  copy_mesh(*mesh, *writer);
  print_summary(arguments.output, mesh->topology());
}

}  // namespace

void add_generate(CLI::App& program) {
  auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* command = program.add_subcommand("generate", "Write a test mesh of any size");
  command->add_option("KIND", arguments->kind, "torus terrain grid plate scan sierpinski")->required();
  command->add_option("-o,--output", arguments->output, "Mesh to write: .ply .obj .off")->required();
  command->add_option("--triangles", arguments->mesh.triangles, "Approximate number of triangles (10000, 12M, 372M)")
      ->transform(CLI::AsNumberWithUnit(
          std::map<std::string, std::uint64_t>{{"k", 1'000}, {"m", 1'000'000}, {"g", 1'000'000'000}}))
      ->capture_default_str();
  command->add_option("--order", arguments->order, "rows, patches or random")->capture_default_str();
  command->add_option("--seed", arguments->mesh.seed, "Seed of noise, handles and random order")->capture_default_str();
  command->add_option("--width", arguments->mesh.width, "Cells in a row of the grid");
  command->add_option("--dimension", arguments->mesh.dimension, "Dimension of a sierpinski simplex: 2 to 5")
      ->capture_default_str();
  command->add_flag("--force", arguments->force, "Replace an existing output");
  command->footer("Example:\n  reeb generate scan --triangles 12M --order patches --seed 7 -o scan.ply");
  command->callback([arguments] { run_generate(*arguments); });
}

}  // namespace reeb::tools
