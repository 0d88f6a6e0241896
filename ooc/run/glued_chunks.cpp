#include "ooc/run/glued_chunks.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "ooc/chunks/divided_chunks.h"
#include "ooc/run/freed_memory.h"
#include "ooc/run/pipeline.h"
#include "ooc/run/stopwatch.h"

namespace reeb::ooc {
namespace {

// The first chunks need code that later ones do not need, and buffers that grow. Each time the number of chunks has
// doubled, what was not needed since then is returned.
constexpr std::uint64_t kChunksOfStart = 64;

}  // namespace

FirstStageResult glue_chunks(RunContext& run, ChunkSource& stretches, const MemoryPlan& plan, Checkpoint here,
                             FirstStageResult result, const std::function<void(std::size_t, const Glue&)>& at_end) {
  const Stopwatch watch;
  // The boxes of a grid are small.
  const bool is_of_grid = here.origin == ChunkOrigin::kGrid || here.origin == ChunkOrigin::kMaskedGrid;
  std::optional<DividedChunks> divided;
  if (!is_of_grid) divided.emplace(stretches, plan.chunk, run.budget, plan.threads);
  ChunkSource& source = is_of_grid ? stretches : *divided;
  std::vector<GraphSink*> sinks;
  for (const auto& store : run.stores) sinks.push_back(store.get());
  if (run.follower) sinks.assign(1, run.follower.get());
  PipelineOptions options;
  options.threads = plan.threads;
  options.are_boxes = here.origin == ChunkOrigin::kGrid;
  options.choose_sweep = [&](std::size_t, const ValueRange& range) {
    SweepOptions sweep = sweep_options(run.options, range);
    sweep.follows_vertices = run.follower != nullptr;
    return sweep;
  };
  if (run.follower) options.log = &run.follower->log();
  std::uint64_t chunks = 0;
  options.progress = [&](const SourceProgress& at) {
    if (++chunks >= kChunksOfStart && std::has_single_bit(chunks)) {
      return_freed_memory();
      return_code();
    }
    run.tell({ComputeProgress::Phase::kReeb, at.bytes_read, at.bytes_total, at.triangles_read});
    // A layer of a grid has many chunks, and a run can be saved after the last of them only.
    if (is_of_grid && !run.resumable.can_be_saved()) run.resumable.check_interruption();
  };
  options.between_chunks = [&](const ChunkPlace& place, const SaveEngine& save_engine) {
    here.place = place;
    run.resumable.between_chunks(here, [&](StateWriter& out) {
      for (const auto& store : run.stores) store->save(out);
      save_engine(out);
    });
  };
  options.saved_engine = run.resumable.saved_engine();
  options.at_end = at_end;
  PipelineResult done = run_pipeline(source, sinks, run.budget, options);
  result.live = done.live;
  result.removed_pairs = std::move(done.removed_pairs);
  result.simplices = source.simplices_listed();
  result.vertices = source.vertex_count();
  result.vertex_bound = source.vertex_bound();
  if (done.restored_vertex_bound > result.vertex_bound) throw DamagedState();
  for (const auto& store : run.stores)
    if (store->restored_vertex_bound() > result.vertex_bound) throw DamagedState();
  result.seconds.reeb += watch.seconds();
  return result;
}

std::uint64_t listed_as_degenerate(std::uint64_t read, const SimplexCounts& listed) {
  return read - std::min(read, listed[0] + listed[1]);
}

}  // namespace reeb::ooc
