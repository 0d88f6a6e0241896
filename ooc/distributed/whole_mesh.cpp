#include "ooc/distributed/whole_mesh.h"

#include <optional>
#include <utility>

#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/run/mesh_order.h"

namespace reeb::ooc {
namespace {

using Phase = ComputeProgress::Phase;

}  // namespace

WholeMesh open_whole_mesh(RunContext& run, MeshInput& input, std::uint32_t parts) {
  WholeMesh whole;
  whole.info = identify_whole_mesh(input);
  if (input.indexed) {
    whole.mesh = std::move(input.indexed);
  } else {
    auto spooled = spool(*input.reader, run.temp, run.budget,
                         {.allowance_bytes = run.plan.table_bytes, .progress = [&](const MeshReader& reader) {
                            run.tell({Phase::kSpool, reader.bytes_read(), reader.info().file_bytes});
                          }});
    whole.notes = input.reader->warnings();
    whole.spilled_bytes = spooled->spilled_bytes();
    whole.mesh = std::move(spooled);
    input.reader.reset();
  }
  whole.info.shares = {0, whole.mesh->vertex_count(), parts};
  whole.info.numbers = whole.mesh->number_count();
  if (const auto triangles = whole.mesh->triangles_by_size()) {
    whole.by_size = true;
    whole.info.shares.triangles = whole.info.simplices[2] = *triangles;
  } else {
    count_triangles(run, whole);
  }
  return whole;
}

void count_triangles(RunContext& run, WholeMesh& whole) {
  constexpr std::size_t kTrianglesAtOnce = 16384;
  IndexedMesh& mesh = *whole.mesh;
  std::uint64_t triangles = 0;
  mesh.rewind();
  for (std::vector<VertexId> corners; mesh.read(corners, kTrianglesAtOnce); triangles += corners.size() / 3)
    run.tell({Phase::kSpool, mesh.bytes_read(), mesh.bytes_total()});
  whole.info.shares.triangles = triangles;
  whole.info.simplices = mesh.simplex_counts();
  whole.by_size = false;
}

PartUses find_part_uses(RunContext& run, const MeshInput& input, WholeMesh& mesh) {
  const Shares& shares = mesh.info.shares;
  // Faces of other sizes never make up for each other: a polygon of k corners counts as k - 2 triangles, but an
  // edge or a point counts as one. So where the size is that of triangles, and their number, too, all are triangles.
  const auto fits = [&](const LastUse& uses) { return uses.summary().triangle_count == shares.triangles; };
  const auto count_if_guessed = [&] {
    if (mesh.by_size) count_triangles(run, mesh);
  };
  if (const std::string sidecar = sidecar_path(run, input); !sidecar.empty()) {
    SidecarLoad known =
        load_sidecar(sidecar, identify_mesh(input.path), shares.vertices, run.temp, run.budget, run.plan.table_bytes);
    if (known.uses && !fits(*known.uses)) count_if_guessed();
    if (known.uses && fits(*known.uses))
      return {std::move(*known.uses), shares,
              input_changed("the sidecar " + sidecar + " is of other content than the mesh",
                            "remove the sidecar, and make all parts again")};
    if (!known.note.empty()) mesh.notes.push_back(known.note);
  }
  const auto scan = [&] {
    LastUseOptions options;
    options.block_triangles = shares.size();
    options.allowance_bytes = run.plan.table_bytes;
    options.threads = run.plan.threads;
    options.progress = [&](std::uint64_t read) { run.tell({Phase::kFinalization, read, mesh.mesh->bytes_total()}); };
    return scan_last_use(*mesh.mesh, run.temp, run.budget, options);
  };
  std::optional<LastUse> uses = scan();
  if (!fits(*uses)) {
    count_if_guessed();
    uses.reset();
    uses = scan();
  }
  return {std::move(*uses), shares};
}

PagedTable<std::uint32_t> empty_uses(RunContext& run) {
  return {"last uses", run.temp, run.budget, run.plan.table_bytes, UseEntry::kUnused};
}

PartUses uses_of_table(PagedTable<std::uint32_t> table, const Shares& shares, Error if_wrong) {
  UseSummary summary;
  summary.vertex_count = shares.vertices;
  summary.triangle_count = shares.triangles;
  summary.block_triangles = shares.size();
  return {LastUse(std::move(summary), std::move(table)), shares, std::move(if_wrong)};
}

}  // namespace reeb::ooc
