#include "ooc/run/first_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "io/file/atomic_file.h"
#include "libreeb/base/error.h"
#include "libreeb/port/wrapped_reader.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/grids/grid_chunks.h"
#include "ooc/grids/grid_layers.h"
#include "ooc/guesses/guessed_chunks.h"
#include "ooc/run/glued_chunks.h"
#include "ooc/run/mesh_order.h"
#include "ooc/run/stopwatch.h"

// Each step below takes the result as it is so far and returns it with its own part. `start` is the
// checkpoint to resume from, or null.
namespace reeb::ooc {
namespace {

using Phase = ComputeProgress::Phase;

void append(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

void check_ranges(const std::vector<ValueRange>& ranges, std::size_t functions) {
  const auto is_sound = [](const ValueRange& range) {
    return std::isfinite(range.min) && std::isfinite(range.max) && range.min <= range.max;
  };
  if (ranges.size() != functions || !std::ranges::all_of(ranges, is_sound)) throw DamagedState();
}

ChunkPlace place_of(const Checkpoint* start) { return start != nullptr ? start->place : ChunkPlace{}; }

// Ends an interrupted run while no triangle comes. Otherwise the run ends after the current chunk, where it can be
// saved; chunks in flight get kSecondsForChunks.
class PolledReader : public WrappedReader {
 public:
  PolledReader(std::unique_ptr<MeshReader> reader, const ResumableRun& run)
      : WrappedReader(std::move(reader)), run_(run) {}

  bool read(MeshBatch& batch) override {
    const bool some = WrappedReader::read(batch);
    const bool may_end = batch.simplex_count() == 0 && run_.is_interrupted();
    if (!may_end)
      waiting_.reset();
    else if (!waiting_)
      waiting_.emplace();
    else if (waiting_->seconds() > kSecondsForChunks)
      run_.check_interruption();
    return some;
  }

 private:
  static constexpr double kSecondsForChunks = 0.2;

  const ResumableRun& run_;
  std::optional<Stopwatch> waiting_;  // since the interruption was seen, with no triangle since then
};

// ---- a stream that finalizes its vertices

struct StreamRun {
  FirstStageResult result;
  bool gave_up = false;  // too many vertices are live at once
};

// Glues the stream as it comes. It gives up only if the stream can be read again; then the stores are empty.
StreamRun run_stream(RunContext& run, const MeshInput& input, const Checkpoint* start, FirstStageResult result) {
  std::optional<std::uint64_t> most_active_vertices;
  if (run.options.may_reorder && input.read_again) most_active_vertices = run.plan.most_live_vertices();
  const auto source =
      chunks_of(*input.reader, run.values, run.budget, run.plan.chunk, place_of(start), most_active_vertices);
  result = glue_chunks(run, *source, run.plan, {.origin = ChunkOrigin::kStream}, std::move(result));
  if (source->given_up()) {
    result.notes.push_back(
        "too many vertices of the stream are live at once, so it was read again, by way of a copy on disk");
    run.start_over();
    return {std::move(result), true};
  }
  for (VertexFunction* function : run.functions) function->check_count(result.vertex_bound);
  append(result.notes, input.reader->warnings());
  return {std::move(result), false};
}

bool needs_lookup(const RunContext& run) {
  return std::any_of(run.functions.begin(), run.functions.end(),
                     [](const VertexFunction* function) { return function->needs_lookup(); });
}

// ---- a grid

bool is_of_grid(const Checkpoint& start) {
  return start.origin == ChunkOrigin::kGrid || start.origin == ChunkOrigin::kMaskedGrid;
}

// Boxes without triangles are faster, but their vertices cannot be followed, and all of them must be there.
FirstStageResult run_grid(RunContext& run, const MeshInput& input, const Checkpoint* start, FirstStageResult result) {
  const bool has_triangles = run.follower != nullptr || !input.reader->info().vertex_count;
  const auto chunks = has_triangles ? chunks_of_masked_grid : chunks_of_grid;
  const ChunkOrigin origin = has_triangles ? ChunkOrigin::kMaskedGrid : ChunkOrigin::kGrid;
  if (start != nullptr && start->origin != origin) throw DamagedState();
  const bool is_volume = GridAxes(input.reader->info().grid->size).count == 3;
  const std::size_t box = has_triangles && is_volume ? run.plan.box_triangles() : run.plan.chunk.first;
  const auto source = chunks(*input.reader, run.values, run.budget, box, place_of(start));
  result = glue_chunks(run, *source, run.plan, {.origin = origin}, std::move(result));
  for (VertexFunction* function : run.functions) function->check_count(result.vertex_bound);
  append(result.notes, input.reader->warnings());
  return result;
}

// ---- a mesh that is read once, and kept on disk for what cannot be done meanwhile

// No guessing when last uses are known or must be kept, or when a function must look up a vertex first; nor when values
// come from a file, whose count is checked against the vertex count before the run, and which may take memory. A run
// that is resumed does as it began.
bool may_guess(const RunContext& run, const MeshInput& input, const Checkpoint* start) {
  if (start != nullptr) return start->origin == ChunkOrigin::kGuessed;
  if (!run.options.may_guess || run.options.keep_sidecar || needs_lookup(run)) return false;
  if (const std::string sidecar = sidecar_path(run, input); !sidecar.empty() && io::is_regular_file(sidecar))
    return false;
  return std::all_of(run.functions.begin(), run.functions.end(),
                     [](const VertexFunction* function) { return function->source_file().empty(); });
}

struct GuessedRun {
  FirstStageResult result;
  bool done = false;  // guesses held: the stores are filled
};

// Glues chunks while the mesh is read for the first time. If guesses do not hold, the stores are empty afterwards.
GuessedRun run_guessing(RunContext& run, FirstReading& reading, const MemoryPlan& plan, const Checkpoint* start,
                        FirstStageResult result) {
  const ChunkSize chunk = start != nullptr ? start->chunk : plan.chunk;
  const std::uint64_t most =
      std::max({std::uint64_t{plan.chunk.most}, std::uint64_t{run.options.chunk_triangles}, reading.bytes_total()});
  if (chunk.first == 0 || chunk.first > chunk.most || chunk.most > most) throw DamagedState();
  GuessedChunks source(reading, run.values, run.temp, run.budget,
                       {.chunk = chunk,
                        .allowance_bytes = plan.table_bytes,
                        .most_open_vertices = plan.most_live_vertices(),
                        // Two threads are busy with the rest of the pipeline.
                        .threads = plan.threads > 2 ? plan.threads : 1},
                       place_of(start));
  result = glue_chunks(run, source, plan, {.origin = ChunkOrigin::kGuessed, .chunk = chunk}, std::move(result));
  const UseGuesses& guesses = source.guesses();
  result.guessed_vertices = guesses.guessed_vertices();
  result.revoked_guesses = guesses.revoked_guesses();
  result.spilled_bytes += guesses.spilled_bytes();
  if (source.given_up()) {
    run.start_over();
    return {std::move(result)};
  }
  result.unused_vertices = guesses.unused_vertices();
  result.degenerate_triangles = listed_as_degenerate(guesses.degenerate_triangles(), result.simplices);
  return {std::move(result), true};
}

struct SpooledRun {
  FirstStageResult result;
  bool done = false;  // guesses held: the stores are filled
  std::unique_ptr<SpooledMesh> mesh = {};
};

// Runs in one pass if guesses hold; else the mesh is to be run from disk.
SpooledRun run_spooled(RunContext& run, const MeshInput& input, const Checkpoint* start, FirstStageResult result) {
  Spooler spooler(*input.reader, run.temp, run.budget,
                  {.allowance_bytes = run.plan.table_bytes, .progress = [&](const MeshReader& reader) {
                     run.tell({Phase::kSpool, reader.bytes_read(), reader.info().file_bytes});
                   }});
  SpooledRun spooled{std::move(result)};
  if (!input.reader->info().finalizes && may_guess(run, input, start)) {
    SpooledReading reading(spooler);
    GuessedRun guessed = run_guessing(run, reading, run.plan, start, std::move(spooled.result));
    spooled.result = std::move(guessed.result);
    spooled.done = guessed.done;
  }
  const Stopwatch watch;
  spooled.mesh = spooler.finish();
  spooled.result.seconds.finalization += watch.seconds();
  spooled.result.spilled_bytes += spooled.mesh->spilled_bytes();
  append(spooled.result.notes, input.reader->warnings());
  return spooled;
}

// ---- an indexed mesh, with its last uses known

// The content of the sidecar is not that of the mesh.
struct WrongSidecar {};

// `mesh` is the mesh of the input, or was spooled from it. It stays if the sidecar is wrong.
// THROWS: WrongSidecar, if one may be used.
FirstStageResult run_once(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh>& mesh,
                          const Checkpoint* start, bool use_sidecar, FirstStageResult result) {
  OrderedMesh ordered = order_mesh(run, input, std::move(mesh), start, use_sidecar);
  append(result.notes, ordered.notes);
  result.reordered = ordered.origin == ChunkOrigin::kSorted || ordered.origin == ChunkOrigin::kSortedInSlabs;
  result.spilled_bytes += ordered.spilled_bytes;
  result.seconds.finalization += ordered.seconds.finalization;
  result.seconds.reorder += ordered.seconds.reorder;
  const UseSummary& summary = ordered.uses.summary();
  result.unused_vertices = summary.unused_vertices;
  const Checkpoint here{.block_triangles = summary.block_triangles, .origin = ordered.origin};
  try {
    const auto source = chunks_of(*ordered.mesh, ordered.uses, run.values, ordered.plan.chunk, place_of(start));
    result = glue_chunks(run, *source, ordered.plan, here, std::move(result));
    result.degenerate_triangles = listed_as_degenerate(summary.degenerate_triangles, result.simplices);
  } catch (const Error& error) {
    if (error.cause() != ErrorCause::kChanged || !ordered.of_sidecar) throw;
    mesh = std::move(ordered.mesh);
    throw WrongSidecar();
  }
  append(result.notes, ordered.mesh->warnings());
  return result;
}

// The front of a coherent surface is hardly larger.
std::uint64_t surface_front(std::uint64_t vertices) {
  return static_cast<std::uint64_t>(1.5 * std::sqrt(static_cast<double>(vertices)));
}

// Whether a mesh has hardly any boundary, where vertices would stay open until the end. A closed surface has about
// twice as many triangles as vertices. Each edge of its boundary, and each unused vertex, is one triangle less.
bool seems_closed(const IndexedMesh& mesh) {
  const std::optional<std::uint64_t> triangles = mesh.triangles_by_size();
  const auto vertices = static_cast<double>(mesh.vertex_count());
  return triangles && 2 * vertices - static_cast<double>(*triangles) < std::sqrt(vertices);
}

// One reading instead of two, if guesses hold.
GuessedRun run_guessing_in_place(RunContext& run, IndexedMesh& mesh, const Checkpoint* start, FirstStageResult result) {
  const std::uint64_t vertices = mesh.vertex_count();
  MemoryPlan plan = run.plan;
  plan.share_out({.vertices = vertices, .live_vertices = surface_front(vertices)});
  ReadingInPlace reading(mesh);
  GuessedRun guessed = run_guessing(run, reading, plan, start, std::move(result));
  if (guessed.done) append(guessed.result.notes, mesh.warnings());
  return guessed;
}

// `mesh` is the mesh of the input, or was spooled from it.
FirstStageResult run_indexed(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh> mesh,
                             const Checkpoint* start, FirstStageResult result) {
  const Reservation values = prepare_values(run, mesh->vertex_count());
  for (VertexFunction* function : run.functions) function->look_up(*mesh);
  const FirstStageResult before = result;
  try {
    return run_once(run, input, mesh, start, true, std::move(result));
  } catch (const WrongSidecar&) {
    run.check_inputs();
    result = before;
  }
  run.start_over();
  result.notes.push_back(ignored_sidecar(sidecar_path(run, input), "its content is not that of the mesh"));
  return run_once(run, input, mesh, nullptr, false, std::move(result));
}

// A mesh that is indexed as it is stored.
FirstStageResult run_in_place(RunContext& run, MeshInput& input, const Checkpoint* start, FirstStageResult result) {
  const bool is_suitable =
      start != nullptr ||
      (seems_closed(*input.indexed) && surface_front(input.indexed->vertex_count()) <= run.plan.most_live_vertices());
  if (is_suitable && may_guess(run, input, start)) {
    GuessedRun guessed = run_guessing_in_place(run, *input.indexed, start, std::move(result));
    if (guessed.done) return std::move(guessed.result);
    result = std::move(guessed.result);
    start = nullptr;
  }
  return run_indexed(run, input, std::move(input.indexed), start, std::move(result));
}

// An indexed mesh can be looked up. A stream is glued as it comes, unless that takes too much memory. Any other mesh is
// spooled. Guesses can suffice to glue it meanwhile; if not, or if a function must look up a vertex first, it is then
// run as an indexed mesh.
FirstStageResult run_first_stage(RunContext& run, MeshInput input) {
  FirstStageResult result;
  const Checkpoint* start = start_run(run, result.notes);
  if (input.indexed) return run_in_place(run, input, start, std::move(result));

  input.reader = std::make_unique<PolledReader>(std::move(input.reader), run.resumable);
  // Not all edges of boxes are seen.
  const bool may_take_boxes = !needs_lookup(run) && !run.options.manifold;
  if ((start == nullptr || is_of_grid(*start)) && may_take_boxes && input.reader->leave_out_simplices())
    return run_grid(run, input, start, std::move(result));
  const bool may_stream = input.reader->info().finalizes && !needs_lookup(run);
  if (may_stream && (start == nullptr || start->origin == ChunkOrigin::kStream)) {
    StreamRun stream = run_stream(run, input, start, std::move(result));
    if (!stream.gave_up) return std::move(stream.result);
    input.reader = std::make_unique<PolledReader>(input.read_again(), run.resumable);
    result = std::move(stream.result);
  }
  SpooledRun spooled = run_spooled(run, input, run.resumable.checkpoint(), std::move(result));
  if (spooled.done) return std::move(spooled.result);
  input.reader.reset();
  return run_indexed(run, input, std::move(spooled.mesh), run.resumable.checkpoint(), std::move(spooled.result));
}

}  // namespace

const Checkpoint* start_run(RunContext& run, std::vector<std::string>& notes) {
  for (const std::string& output : run.outputs) io::remove_abandoned(output);
  const auto restore = [&run](StateReader& in) {
    check_ranges(run.resumable.checkpoint()->place.ranges, run.functions.size());
    run.restore_stores(in);
  };
  const Checkpoint* start = run.resumable.start(restore, notes);
  // An earlier run may have written outputs only if this one continues it.
  if (!run.options.replace && !run.resumable.was_resumed())
    for (const std::string& output : run.outputs) io::check_output_name(output, io::Existing::kRefuse);
  return start;
}

// Whatever goes wrong with an input that changes is due to the change.
FirstStageResult read_mesh(RunContext& run, MeshInput input) {
  const std::string mesh = input.path;
  run.check_inputs();  // the run was identified by the names of its files
  try {
    FirstStageResult first = run_first_stage(run, std::move(input));
    run.check_inputs();
    return first;
  } catch (Error& error) {
    run.check_inputs();
    const bool changed = error.cause() == ErrorCause::kChanged;
    if (changed || error.cause() == ErrorCause::kNotManifold) error.at(mesh);
    if (!changed || run.resumable.checkpoint() == nullptr) throw;
    throw input_changed("the mesh has changed since the interrupted run",
                        "start again with --force and without --resume")
        .at(mesh);
  } catch (const std::exception&) {
    run.check_inputs();
    throw;
  }
}

}  // namespace reeb::ooc
