#include "tools/defects/find_defects.h"

#include <algorithm>
#include <array>

#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/run/freed_memory.h"
#include "ooc/whole_mesh/workspace.h"
#include "tools/library/temp_folder.h"
#include "tools/program/simplex_text.h"

namespace reeb::tools {
namespace {

std::vector<std::string> coordinates(unsigned dimension) {
  std::vector<std::string> names = {"x", "y", "z"};
  names.resize(std::clamp<std::size_t>(dimension, 1, 3));
  return names;
}

// Loops do not depend on noise removal, which leaves nearly nothing else of a rough graph.
std::vector<std::string> compute_graphs(const FindDefectsOptions& options, const TempFolder& folder) {
  const ValuedMesh mesh(options.mesh, {});
  const std::vector<std::string> functions =
      options.functions.empty() ? coordinates(mesh.info().dimension) : options.functions;
  std::vector<std::string> files;
  for (std::size_t k = 0; k < functions.size(); ++k) files.push_back(folder.path() + "/" + std::to_string(k) + ".reeb");
  ComputeOptions run;
  run.memory_bytes = options.mesh.memory_bytes;
  run.threads = options.threads;
  run.format = options.mesh.format;
  run.image = options.mesh.image;
  run.temp_dir = folder.path();
  run.graph_only = true;
  run.buckets = 0;
  run.denoise = 1;
  run.denoise_is_share = true;
  run.keeps_checkpoints = false;
  run.progress = options.computing;
  run.interrupted = options.mesh.interrupted;
  const std::vector<ComputeResult> results = compute(options.mesh.path, functions, files, run);
  const std::span<const std::uint64_t> cells = std::span(results[0].simplices).subspan(3);
  if (std::ranges::any_of(cells, [](std::uint64_t count) { return count != 0; }))
    refuse_cells(options.mesh.path, mesh.info().grid.has_value());
  return files;
}

// The user did not give these graphs. If one cannot be read, the disk is to blame.
LoopList loops_of_mesh(const FindDefectsOptions& options, MemoryBudget& budget) {
  const TempFolder folder(options.mesh.temp_folder);
  const std::vector<std::string> files = compute_graphs(options, folder);
  try {
    return read_loops(files, budget);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kBadInput) throw;
    throw Error(ErrorKind::kResource, error.message(), "check the disk, or choose another folder with --temp-dir")
        .at(error.file(), error.position());
  }
}

// Graphs of another mesh would give other places, and their loops no curves. Enlarges `box`, that of the nodes, to that
// of the mesh: the nodes of one function can lie on a line.
void look_at_mesh(const FindDefectsOptions& options, const LoopFunction& graph, const SearchOptions& search,
                  std::array<Point, 2>& box) {
  const ValuedMesh mesh(options.mesh, {});
  MeshCounts counts;
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
    if (batch.has_cells()) refuse_cells(options.mesh.path, mesh.info().grid.has_value());
    counts.vertices += batch.vertex_count;
    counts.triangles += batch.triangle_count();
    for (std::size_t k = 0; k < std::min<std::size_t>(batch.coordinates.size(), 3) && batch.vertex_count != 0; ++k) {
      const auto [least, greatest] = std::ranges::minmax(batch.coordinates[k]);
      box[0][k] = std::min(box[0][k], least);
      box[1][k] = std::max(box[1][k], greatest);
    }
    search.progress(done, total, counts.triangles);
  });
  require_same_mesh(graph.file, graph.mesh, counts);
}

}  // namespace

Defects find_defects(const FindDefectsOptions& options) {
  const std::uint64_t set_aside = ooc::set_aside_of(options.mesh.memory_bytes);
  MemoryBudget budget(options.mesh.memory_bytes - set_aside, set_aside);
  LoopList list = options.files.empty() ? loops_of_mesh(options, budget) : read_loops(options.files, budget);
  ooc::return_freed_memory();
  SearchOptions search;
  search.threads = options.threads;
  const io::TempDir temp(options.mesh.temp_folder);
  search.temp = &temp;
  search.budget = &budget;
  search.patch_bytes = std::min(search.patch_bytes, options.mesh.memory_bytes / 8);
  search.progress = [&](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
    options.mesh.check_interruption();
    if (options.searching) options.searching(done, total, triangles);
  };
  // The nodes of all coordinates show how large the mesh is.
  if (!options.files.empty() || !options.functions.empty()) look_at_mesh(options, list.functions[0], search, list.box);
  Defects defects;
  for (const LoopFunction& function : list.functions) defects.functions.push_back(function.name);
  const LoopFunction& first = list.functions[0];
  defects.note = text_if_apart(first.mesh.triangles, first.components, first.arcs);
  const ValuedMesh mesh(options.mesh, defects.functions);
  const LoopCurvesFound found = find_curves(mesh, list, scale_of(list), search);
  defects.scale = found.scale;
  defects.table = make_rows(mesh, list, found, search, options.named);
  return defects;
}

}  // namespace reeb::tools
