#include "ooc/distributed/part_run.h"

#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/distributed/part_chunks.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/glued_chunks.h"
#include "ooc/run/mesh_order.h"
#include "ooc/run/stopwatch.h"

namespace reeb::ooc {
namespace {

PartInfo info_of(const WholeMesh& mesh, const VertexFunction& function, std::uint32_t part,
                 const ComputeOptions& wanted) {
  PartInfo info;
  info.mesh = mesh.info;
  info.function = function.name();
  if (const std::string file = function.source_file(); !file.empty()) info.values_digest = identify_mesh(file).digest;
  info.denoise = wanted.denoise;
  info.denoise_is_share = wanted.denoise_is_share;
  info.buckets = wanted.buckets;
  info.graph_only = wanted.graph_only;
  info.runs = {{part, part}};
  return info;
}

// The live graph is held as well while it is copied.
void copy_open(RunContext& run, const Glue& glue, const IndexedMesh& mesh, PartUses& uses, std::uint32_t part,
               FinishedPart& finished) {
  const std::size_t span_bytes = glue.graph().node_count() * sizeof(PartSpan);
  finished.memory = run.budget.reserve("open part", glue.copy_bytes() + span_bytes);
  OpenPart& open = finished.open;
  glue.copy_live(open.live);
  std::vector<VertexId> ids;
  for (const Fragment::Node& node : open.live.nodes)
    if (node.uses != kUsedHereOnly) ids.push_back(node.key.vertex);
  mesh.from_original(ids);
  std::vector<PartSpan> spans;
  uses.find(ids, part, spans);
  open.spans.assign(open.live.nodes.size(), {});
  std::size_t next = 0;
  for (std::size_t n = 0; n < open.live.nodes.size(); ++n)
    if (open.live.nodes[n].uses != kUsedHereOnly) open.spans[n] = spans[next++];
  finished.memory.resize(open.live.memory_bytes() + open.spans.size() * sizeof(PartSpan));
}

}  // namespace

ComputeOptions options_of_share(ComputeOptions options) {
  if (options.denoise_is_share) options.denoise = 0;
  options.denoise_is_share = false;
  return options;
}

PartResult run_part(RunContext& run, const MeshInput& input, WholeMesh& mesh, PartUses& uses, std::uint32_t part,
                    const ComputeOptions& wanted) {
  const Stopwatch watch;
  PartResult result;
  result.notes = mesh.notes;
  const Shares& shares = mesh.info.shares;
  const Checkpoint* start = start_run(run, result.notes);
  const Reservation values = prepare_values(run, shares.vertices);
  for (VertexFunction* function : run.functions) function->look_up(*mesh.mesh);

  MeshInput share;  // without a sidecar: that of the mesh is of all of it
  share.dimension = input.dimension;
  share.path = "-";
  OrderedMesh ordered = order_mesh(run, share, mesh.share(part), start, false);
  ordered.uses.leave_out_unused();
  result.notes.insert(result.notes.end(), ordered.notes.begin(), ordered.notes.end());
  const UseSummary& summary = ordered.uses.summary();
  const Checkpoint here{.block_triangles = summary.block_triangles, .origin = ordered.origin};
  const ChunkPlace place = start != nullptr ? start->place : ChunkPlace{};
  const auto triangles = chunks_of(*ordered.mesh, ordered.uses, run.values, ordered.plan.chunk, place);
  PartChunks chunks(*triangles, *mesh.mesh, uses, part, run.values, place);

  for (const VertexFunction* function : run.functions)
    result.parts.push_back({info_of(mesh, *function, part, wanted), {}, {}});
  const auto at_end = [&](std::size_t f, const Glue& glue) {
    copy_open(run, glue, *mesh.mesh, uses, part, result.parts[f]);
  };
  const FirstStageResult first = glue_chunks(run, chunks, ordered.plan, here, {}, at_end);
  run.check_inputs();
  for (std::size_t f = 0; f < run.functions.size(); ++f) {
    FinishedPart& finished = result.parts[f];
    PartInfo& info = finished.info;
    info.range = run.values.range(f);
    info.degenerate_triangles = summary.degenerate_triangles;
    info.unused_vertices = chunks.unused_vertices();
    info.removed_pairs = first.removed_pairs[f];
    info.live = first.live;
    finished.open.live.options = info.sweep();
    if (!info.sweep().bucket_exponent) finished.open.live.bucket_begin.clear();
    run.stores[f]->finish();
    info.settled_nodes = run.stores[f]->node_count();
    info.settled_arcs = run.stores[f]->arc_count();
  }
  result.seconds.wall = watch.seconds();
  return result;
}

}  // namespace reeb::ooc
