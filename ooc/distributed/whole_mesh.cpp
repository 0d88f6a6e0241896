#include "ooc/distributed/whole_mesh.h"

#include <optional>
#include <utility>

#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/run/mesh_order.h"

namespace reeb::ooc {
namespace {

using Phase = ComputeProgress::Phase;

std::uint64_t count_triangles(RunContext& run, IndexedMesh& mesh) {
  constexpr std::size_t kTrianglesAtOnce = 16384;
  std::uint64_t triangles = 0;
  mesh.rewind();
  for (std::vector<VertexId> corners; mesh.read(corners, kTrianglesAtOnce); triangles += corners.size() / 3)
    run.tell({Phase::kSpool, mesh.bytes_read(), mesh.bytes_total()});
  return triangles;
}

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
  whole.info.shares = {count_triangles(run, *whole.mesh), whole.mesh->vertex_count(), parts};
  whole.info.simplices = whole.mesh->simplex_counts();
  return whole;
}

PartUses find_part_uses(RunContext& run, const MeshInput& input, WholeMesh& mesh) {
  const Shares& shares = mesh.info.shares;
  if (const std::string sidecar = sidecar_path(run, input); !sidecar.empty()) {
    SidecarLoad known =
        load_sidecar(sidecar, identify_mesh(input.path), shares.vertices, run.temp, run.budget, run.plan.table_bytes);
    if (known.uses && known.uses->summary().triangle_count == shares.triangles) return {std::move(*known.uses), shares};
    if (!known.note.empty()) mesh.notes.push_back(known.note);
  }
  LastUseOptions options;
  options.block_triangles = shares.size();
  options.allowance_bytes = run.plan.table_bytes;
  options.threads = run.plan.threads;
  options.progress = [&](std::uint64_t read) { run.tell({Phase::kFinalization, read, mesh.mesh->bytes_total()}); };
  return {*scan_last_use(*mesh.mesh, run.temp, run.budget, options), shares};
}

PagedTable<std::uint32_t> empty_uses(RunContext& run) {
  return {"last uses", run.temp, run.budget, run.plan.table_bytes, UseEntry::kUnused};
}

PartUses uses_of_table(PagedTable<std::uint32_t> table, const Shares& shares) {
  UseSummary summary;
  summary.vertex_count = shares.vertices;
  summary.triangle_count = shares.triangles;
  summary.block_triangles = shares.size();
  return {LastUse(std::move(summary), std::move(table)), shares};
}

}  // namespace reeb::ooc
