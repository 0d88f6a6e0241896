// `reeb generate KIND -o MESH`: test meshes of any size, streamed.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/file_name.h"
#include "io/formats/create_mesh.h"
#include "io/generate/generator.h"
#include "io/generate/volume.h"
#include "io/images/raw_grid.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/simplex_text.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

constexpr const char* kUsualOrder = "patches";

struct GenerateArguments {
  std::string kind, order = kUsualOrder, output;
  io::GeneratorOptions mesh;
  std::optional<std::uint64_t> seed, dimension, handles, triangles, tetrahedra;
  std::string grid;  // of a volume
  bool force = false;
};

// `cells` are those of a mesh of whole simplices.
void print_summary(const GenerateArguments& arguments, const io::ExpectedTopology& t, std::uint64_t cells) {
  const bool ball = arguments.mesh.kind == io::MeshKind::kBall;
  const bool whole = arguments.mesh.kind == io::MeshKind::kSierpinski && arguments.mesh.whole_cells;
  const char* const of = ball ? "tetrahedron" : "triangle";
  const std::uint64_t asked = ball ? arguments.mesh.tetrahedra : arguments.mesh.triangles,
                      got = ball ? t.tetrahedra : t.triangles, more = std::max(asked, got) - std::min(asked, got);
  SimplexCounts simplices{};
  simplices[whole ? arguments.mesh.dimension : ball ? 3 : 2] = whole ? cells : got;
  std::string text =
      fmt::format("wrote {}: {}, {}, Euler characteristic {}{}", printable(arguments.output),
                  count_of(t.vertices, "vertex"), count_simplices(simplices),
                  whole && arguments.mesh.dimension > 2 ? "of the 2-skeleton " : "", t.euler_characteristic);
  if (t.genus) text += fmt::format(", genus {}", *t.genus);
  if (t.boundary_loops) text += ", " + count_of(*t.boundary_loops, "boundary");
  if (!t.genus) text += ", first Betti number " + with_commas(t.first_betti);
  print_line(text);
  if (more > asked / 10)
    print_line(fmt::format("note: asked for {}; a {} of {} is the nearest that there is", count_of(asked, of),
                           arguments.kind, with_commas(got)));
}

[[noreturn]] void refuse_option(const GenerateArguments& arguments, const char* option, const std::string& hint) {
  throw Error(ErrorKind::kUsage, fmt::format("a {} has no {}", arguments.kind, option), hint);
}

// An option that would be ignored is refused; a seed that changes nothing is harmless.
void check_options(const GenerateArguments& arguments) {
  const io::MeshKind kind = arguments.mesh.kind;
  const bool sierpinski = kind == io::MeshKind::kSierpinski, ball = kind == io::MeshKind::kBall;
  const auto refuse = [&](const char* option, const std::string& hint) { refuse_option(arguments, option, hint); };
  if (arguments.mesh.width && sierpinski)
    refuse("--width", "leave it out; --triangles and --dimension say how large it is");
  if (arguments.mesh.width && ball) refuse("--width", "leave it out; --tetrahedra says how large it is");
  if (arguments.triangles && ball) refuse("--triangles", "choose --tetrahedra");
  if (arguments.tetrahedra && !ball) refuse("--tetrahedra", "choose --triangles");
  if (arguments.handles && !ball) refuse("--handles", "leave it out; only a ball and a volume have them");
  if (arguments.dimension && !sierpinski) refuse("--dimension", "leave it out; only a sierpinski has one");
  const bool is_random = kind == io::MeshKind::kTerrain || kind == io::MeshKind::kScan ||
                         arguments.mesh.order == io::MeshOrder::kRandom ||
                         arguments.mesh.order == io::MeshOrder::kRandomTiles;
  if (arguments.seed && !is_random)
    print_line(fmt::format("note: nothing is random in a {} in this order, so --seed changes nothing", arguments.kind));
}

void check_volume_options(const GenerateArguments& arguments) {
  const std::string hint = "leave it out; --grid says how large it is";
  if (arguments.triangles) refuse_option(arguments, "--triangles", hint);
  if (arguments.tetrahedra) refuse_option(arguments, "--tetrahedra", hint);
  if (arguments.mesh.width) refuse_option(arguments, "--width", hint);
  if (arguments.dimension) refuse_option(arguments, "--dimension", "leave it out; only a sierpinski has one");
  if (arguments.order != kUsualOrder) refuse_option(arguments, "--order", "leave it out; only meshes have one");
}

io::VolumeOptions volume_options(const GenerateArguments& arguments) {
  if (arguments.grid.empty()) throw Error(ErrorKind::kUsage, "a volume needs its size", "for example --grid 64x64x64");
  io::VolumeOptions options;
  const auto size = io::parse_grid_size(arguments.grid);
  std::copy(size.begin(), size.end(), options.size.begin());
  if (size.size() == 2) options.size[2] = 1;
  options.axes = static_cast<unsigned>(size.size());
  options.handles = arguments.handles.value_or(1);
  options.noise_seed = arguments.seed;
  return options;
}

void generate_volume(const GenerateArguments& arguments) {
  check_volume_options(arguments);
  if (io::name_suffix(arguments.output) != ".nrrd")
    throw Error(ErrorKind::kUsage, "a volume is written as NRRD", "choose an output that ends in .nrrd");
  const io::VolumeOptions options = volume_options(arguments);
  const io::Volume volume(options);
  RunFiles files;
  files.add_output(arguments.output, "the output", existing_outputs(arguments.force));
  files.check();
  io::AtomicFile file(arguments.output, {.existing = late_outputs(arguments.force)});
  file.out().append(volume.nrrd_header());
  std::vector<float> row(options.size[0]);
  ProgressBar bar(false);
  for (std::uint64_t k = 0; k < options.size[2]; ++k)
    for (std::uint64_t j = 0; j < options.size[1]; ++j) {
      volume.row(j, k, row);
      file.out().append(std::as_bytes(std::span(row)));  // little endian
      bar.update({"writing"}, j + options.size[1] * k, options.size[1] * options.size[2]);
    }
  file.commit();
  bar.clear();
  print_line(fmt::format("wrote {}: {}, {}; with --nodata skip, value and x have a graph of 1 component and {}",
                         printable(arguments.output), count_of(volume.vertex_count(), "vertex"),
                         count_of(options.handles, "handle"), count_of(options.handles, "loop")));
}

void run_generate(GenerateArguments arguments) {
  if (arguments.kind == "volume") return generate_volume(arguments);
  if (!arguments.grid.empty())
    throw Error(ErrorKind::kUsage, "only a volume has --grid", "leave it out, or generate a volume");
  arguments.mesh.kind = io::mesh_kind(arguments.kind);
  io::set_order(arguments.mesh, arguments.order);
  check_options(arguments);
  if (arguments.seed) arguments.mesh.seed = *arguments.seed;
  if (arguments.triangles) arguments.mesh.triangles = *arguments.triangles;
  if (arguments.tetrahedra) arguments.mesh.tetrahedra = *arguments.tetrahedra;
  if (arguments.handles) arguments.mesh.handles = *arguments.handles;
  if (arguments.dimension) arguments.mesh.dimension = static_cast<unsigned>(*arguments.dimension);
  io::check_mesh_name(arguments.output);
  if (arguments.mesh.kind == io::MeshKind::kBall && !io::has_tetrahedra(arguments.output))
    throw Error(ErrorKind::kUsage, "a ball consists of tetrahedra, which this format cannot hold",
                "end the name of the output in .sva, .svb, .cx or .events.txt")
        .at(arguments.output);
  arguments.mesh.whole_cells = io::name_suffix(arguments.output) == ".cx";
  RunFiles files;
  files.add_output(arguments.output, "the output", existing_outputs(arguments.force));
  files.check();
  const auto mesh = io::generate_mesh(arguments.mesh);
  const io::ExpectedTopology& topology = mesh->topology();
  io::MeshWriterOptions options;
  options.dimension = mesh->info().dimension;
  options.vertex_count = mesh->info().vertex_count;
  options.existing = late_outputs(arguments.force);
  const auto writer = io::create_mesh(arguments.output, options);
  ProgressBar bar(false);
  std::uint64_t vertices = 0, simplices = 0;
  for (MeshBatch batch; mesh->read(batch);) {
    writer->write(batch);
    vertices += batch.vertex_count;
    simplices += batch.simplex_count();
    bar.update({"writing"}, vertices + simplices, topology.vertices + mesh->info().simplex_count.value_or(0),
               simplices);
  }
  writer->close();
  bar.clear();
  print_summary(arguments, topology, mesh->info().simplex_count.value_or(0));
}

}  // namespace

void add_generate(Program& program) {
  auto arguments = std::make_shared<GenerateArguments>();
  Command command = program.add_command("generate", "Write a test mesh of any size");
  command.add_option("KIND", arguments->kind, "torus, terrain, grid, plate, scan, sierpinski, ball or volume")
      .required()
      .type_name("");
  command
      .add_option("-o,--output", arguments->output,
                  "Mesh to write: .ply .obj .off .cx .sma .smb .smc .sva .svb, a ball: .cx .sva .svb, a volume: .nrrd; "
                  ".events.txt lists the events")
      .required()
      .type_name("FILE");
  add_count(command, "--triangles", arguments->triangles, "About how many triangles: 10000, 12M, 372M (default: 1M)",
            {.least = 1});
  add_count(command, "--tetrahedra", arguments->tetrahedra, "About how many tetrahedra, for a ball (default: 1M)",
            {.least = 1});
  command
      .add_option("--order", arguments->order,
                  "Order of the triangles: rows, patches, random, tiles:N, random-tiles:N or seams-last:N, with N "
                  "cells along a tile's side (default: patches)")
      .type_name("ORDER");
  add_count(command, "--seed", arguments->seed,
            "Seed of noise, handles and random order (default: 1; a volume without it has no noise)");
  add_count(command, "--width", arguments->mesh.width,
            "Cells in a row of the grid (default: about as many as there are rows)", {.least = 1});
  add_count(command, "--dimension", arguments->dimension, "Dimension of a sierpinski, 2 to 5 (default: 3)",
            {.least = 2, .most = 5});
  command.add_option("--grid", arguments->grid, "Vertices of a volume along each axis: 256x256x100")
      .type_name("NXxNY[xNZ]");
  add_count(command, "--handles", arguments->handles, "Tunnels through a ball or a volume (default: 1)");
  add_force(command, arguments->force);
  command.footer("Example:\n  reeb generate scan --triangles 12M --order patches --seed 7 -o scan.ply");
  command.callback([arguments] { run_generate(*arguments); });
}

}  // namespace reeb::tools
