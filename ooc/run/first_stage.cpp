#include "ooc/run/first_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "io/file/atomic_file.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/coherence.h"
#include "ooc/chunks/divided_chunks.h"
#include "ooc/chunks/guessed_chunks.h"
#include "ooc/chunks/last_use.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/run/stopwatch.h"
#include "ooc/whole_mesh/reorder.h"

// Each step below takes the result as it is so far and returns it with its own part. `start` is the
// checkpoint to resume from, or null.
namespace reeb::ooc {
namespace {

using Phase = ComputeProgress::Phase;

void append(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

void check_ranges(const std::vector<FunctionRange>& ranges, std::size_t functions) {
  const auto is_sound = [](const FunctionRange& range) {
    return std::isfinite(range.min) && std::isfinite(range.max) && range.min <= range.max;
  };
  if (ranges.size() != functions || !std::ranges::all_of(ranges, is_sound)) throw DamagedState();
}

ChunkPlace place_of(const Checkpoint* start) { return start != nullptr ? start->place : ChunkPlace{}; }

// Ends an interrupted run while no triangle comes. Else that is left to the end of a chunk, where the run can be saved;
// chunks that are on their way get the time for it.
class PolledReader : public MeshReader {
 public:
  PolledReader(std::unique_ptr<MeshReader> reader, const ResumableRun& run) : reader_(std::move(reader)), run_(run) {}

  const MeshInfo& info() const override { return reader_->info(); }
  bool read(MeshBatch& batch) override {
    const bool some = reader_->read(batch);
    const bool may_end = batch.triangles.empty() && batch.tetrahedra.empty() && run_.is_interrupted();
    if (!may_end)
      waiting_.reset();
    else if (!waiting_)
      waiting_.emplace();
    else if (waiting_->seconds() > kSecondsForChunks)
      run_.check_interruption();
    return some;
  }
  std::unique_ptr<IndexedMesh> indexed() const override { return reader_->indexed(); }
  std::uint64_t bytes_read() const override { return reader_->bytes_read(); }
  std::uint64_t memory_bytes() const override { return reader_->memory_bytes(); }
  std::vector<std::string> warnings() const override { return reader_->warnings(); }

 private:
  static constexpr double kSecondsForChunks = 0.2;

  std::unique_ptr<MeshReader> reader_;
  const ResumableRun& run_;
  std::optional<Stopwatch> waiting_;  // since the interruption was seen, with no triangle since then
};

// ---- from chunks to the stores

// `here` is the content of a checkpoint apart from its place.
FirstStageResult glue_chunks(RunContext& run, ChunkSource& stretches, const MemoryPlan& plan, Checkpoint here,
                             FirstStageResult result) {
  const Stopwatch watch;
  const std::size_t whole = plan.chunk.first + plan.chunk.first / 4;  // the last batch of a stream can exceed it
  DividedChunks source(stretches, whole, plan.chunk.patch, run.budget);
  std::vector<GraphSink*> sinks;
  for (const auto& store : run.stores) sinks.push_back(store.get());
  PipelineOptions options;
  options.threads = plan.threads;
  options.choose_sweep = [&](std::size_t, const FunctionRange& range) { return sweep_options(run.options, range); };
  options.progress = [&](const SourceProgress& at) {
    run.tell({Phase::kReeb, at.bytes_read, at.bytes_total, at.triangles_read});
  };
  options.between_chunks = [&](const ChunkPlace& place, const SaveEngine& save_engine) {
    here.place = place;
    run.resumable.between_chunks(here, [&](StateWriter& out) {
      for (const auto& store : run.stores) store->save(out);
      save_engine(out);
    });
  };
  options.saved_engine = run.resumable.saved_engine();
  PipelineResult done = run_pipeline(source, sinks, run.budget, options);
  result.live = done.live;
  result.removed_pairs = std::move(done.removed_pairs);
  result.triangles = source.triangles_read();
  result.vertices = source.vertex_count();
  if (done.restored_vertex_bound > result.vertices) throw DamagedState();
  for (const auto& store : run.stores)
    if (store->restored_vertex_bound() > result.vertices) throw DamagedState();
  result.seconds.reeb += watch.seconds();
  return result;
}

// ---- a stream that finalizes its vertices

struct StreamRun {
  FirstStageResult result;
  bool gave_up = false;  // too many vertices are live at once
};

// Glues the stream as it comes. It gives up only if the stream can be read again; then the stores are empty.
StreamRun run_stream(RunContext& run, const MeshInput& input, const Checkpoint* start, FirstStageResult result) {
  std::optional<std::uint64_t> most_active_vertices;
  if (run.options.may_reorder && input.read_again && start == nullptr)
    most_active_vertices = run.plan.most_live_vertices();
  const auto source = chunks_of(*input.reader, run.values, run.plan.chunk, place_of(start), most_active_vertices);
  result = glue_chunks(run, *source, run.plan, {.origin = ChunkOrigin::kStream}, std::move(result));
  if (source->given_up()) {
    result.notes.push_back("too many vertices of the stream are live at once, so it was read again and sorted on disk");
    run.start_over();
    return {std::move(result), true};
  }
  for (VertexFunction* function : run.functions) function->check_count(result.vertices);
  append(result.notes, input.reader->warnings());
  return {std::move(result), false};
}

// ---- a mesh that is read once, and kept on disk for what cannot be done meanwhile

// Empty if no sidecar is used. With a chosen chunk size none is: its blocks can be too large for small chunks.
std::string sidecar_path(const RunContext& run, const MeshInput& input) {
  const bool has_file = !input.path.empty() && input.path != "-" && run.options.chunk_triangles == 0;
  return has_file ? input.path + ".final" : "";
}

// No guessing when last uses are known or must be kept, or when values come from a file: its count is
// checked against the vertex count before the run. A run that is resumed does as it began.
bool may_guess(const RunContext& run, const MeshInput& input, const Checkpoint* start) {
  if (start != nullptr) return start->origin == ChunkOrigin::kGuessed;
  if (!run.options.may_guess || run.options.keep_sidecar || input.reader->info().finalizes) return false;
  if (const std::string sidecar = sidecar_path(run, input); !sidecar.empty() && io::is_regular_file(sidecar))
    return false;
  return std::all_of(run.functions.begin(), run.functions.end(),
                     [](const VertexFunction* function) { return function->source_file().empty(); });
}

struct SpooledRun {
  FirstStageResult result;
  bool done = false;  // guesses held: the stores are filled
  std::unique_ptr<SpooledMesh> mesh = {};
};

// Glues chunks while the mesh is spooled. If guesses do not hold, the stores are empty afterwards.
SpooledRun run_guessing(RunContext& run, Spooler& spooler, const Checkpoint* start, FirstStageResult result) {
  const ChunkSize chunk = start != nullptr ? start->chunk : run.plan.chunk;
  const std::uint64_t most = std::max<std::uint64_t>(run.plan.chunk.most, spooler.reader().info().file_bytes);
  if (chunk.first == 0 || chunk.first > chunk.most || chunk.most > most) throw DamagedState();
  GuessedChunks source(
      spooler, run.values, run.temp, run.budget,
      {.chunk = chunk, .allowance_bytes = run.plan.table_bytes, .most_open_vertices = run.plan.most_live_vertices()},
      place_of(start));
  result = glue_chunks(run, source, run.plan, {.origin = ChunkOrigin::kGuessed, .chunk = chunk}, std::move(result));
  const UseGuesses& guesses = source.guesses();
  result.guessed_vertices = guesses.guessed_vertices();
  result.revoked_guesses = guesses.revoked_guesses();
  result.spilled_bytes += guesses.spilled_bytes();
  if (source.given_up()) {
    run.start_over();
    return {std::move(result)};
  }
  result.unused_vertices = guesses.unused_vertices();
  result.degenerate_triangles = guesses.degenerate_triangles();
  return {std::move(result), true};
}

// Runs in one pass if guesses hold; else the mesh is to be run from disk.
SpooledRun run_spooled(RunContext& run, const MeshInput& input, const Checkpoint* start, FirstStageResult result) {
  Spooler spooler(*input.reader, run.temp, run.budget, run.plan.table_bytes);
  SpooledRun spooled{std::move(result)};
  if (may_guess(run, input, start)) spooled = run_guessing(run, spooler, start, std::move(spooled.result));
  const Stopwatch watch;
  spooled.mesh = spooler.finish([&](const MeshReader& reader) {
    run.tell({Phase::kSpool, reader.bytes_read(), reader.info().file_bytes});
  });
  spooled.result.seconds.finalization += watch.seconds();
  spooled.result.spilled_bytes += spooled.mesh->spilled_bytes();
  append(spooled.result.notes, input.reader->warnings());
  return spooled;
}

// ---- an indexed mesh, with its last uses known

// Some functions keep all their values, to look up vertices.
std::uint64_t value_bytes(const RunContext& run, std::uint64_t vertices) {
  std::uint64_t bytes = 0;
  for (const VertexFunction* function : run.functions) bytes += function->lookup_bytes(vertices);
  return bytes;
}

Reservation prepare_values(RunContext& run, std::uint64_t vertices) {
  Reservation reservation = run.budget.reserve("function values", value_bytes(run, vertices));
  for (VertexFunction* function : run.functions) function->check_count(vertices);
  return reservation;
}

FrontNeeds needs(const RunContext& run, const UseSummary& summary) {
  return {summary.vertex_count, summary.max_live_vertices, value_bytes(run, summary.vertex_count)};
}

// Whether to glue the mesh in its own order. If its front does not fit, the mesh is sorted if that can be expected to
// make the front smaller.
bool is_coherent(const RunContext& run, const UseSummary& summary) {
  constexpr double kSortedFront = 2;  // of a sorted mesh, in square roots of its vertices
  const auto sorted = static_cast<std::uint64_t>(kSortedFront * std::sqrt(static_cast<double>(summary.vertex_count)));
  if (!run.plan.fits(needs(run, summary))) return summary.max_live_vertices <= sorted;
  MemoryPlan plan = run.plan;
  plan.share_out(needs(run, summary));
  return summary.max_live_vertices <= usual_front(summary.vertex_count, plan.chunk.most);
}

// The plan with a known front: chunks get what the live graphs leave.
// THROWS: Error{kResource} if the live graphs cannot fit.
MemoryPlan plan_for(const RunContext& run, const UseSummary& summary) {
  MemoryPlan plan = run.plan;
  const FrontNeeds front = needs(run, summary);
  if (plan.exceeds(front)) {
    const std::string megabytes = std::to_string((plan.needed_bytes(front) >> 20) + 1) + "M";
    throw Error(ErrorKind::kResource,
                std::to_string(front.live_vertices) + " vertices are live at once, and their graph will not fit " +
                    format_bytes(plan.set_aside_bytes + plan.budget_bytes) + " of memory",
                "allow --memory " + megabytes +
                    (run.options.may_reorder ? "" : ", or let the triangles be sorted (without --no-reorder)"));
  }
  plan.share_out(front);
  return plan;
}

// Sorting a mesh, and scanning it afterwards, are one pass for who waits.
constexpr double kSorted = 0.9;

void tell_sorting(const RunContext& run, double done) {
  constexpr std::uint64_t kSteps = 10000;
  run.tell({Phase::kReorder, static_cast<std::uint64_t>(done * kSteps), kSteps});
}

// Returns nothing if it may give up and the mesh is so incoherent that it will be sorted anyway. `sorted`: it was
// sorted on disk.
std::optional<LastUse> scan(RunContext& run, IndexedMesh& mesh, const Checkpoint* start, bool may_give_up,
                            bool sorted = false) {
  LastUseOptions options;
  options.allowance_bytes = run.plan.table_bytes;
  options.give_up_when_incoherent = may_give_up;
  // A chunk is whole blocks, so small chunks need small blocks.
  options.block_triangles = std::min<std::uint64_t>(options.block_triangles, run.plan.chunk.first);
  if (start != nullptr) options.block_triangles = start->block_triangles;
  options.threads = run.plan.threads;
  options.progress = [&run, sorted, total = mesh.bytes_total()](std::uint64_t bytes_read) {
    if (!sorted) return run.tell({Phase::kFinalization, bytes_read, total});
    const double done = static_cast<double>(bytes_read) / static_cast<double>(std::max<std::uint64_t>(total, 1));
    tell_sorting(run, kSorted + (1 - kSorted) * done);
  };
  std::optional<LastUse> uses = scan_last_use(mesh, run.temp, run.budget, options);
  if (start != nullptr && uses && !has_usual_blocks(uses->summary())) throw DamagedState();
  return uses;
}

// Whether the place to resume from is at the end of a block.
bool can_start(const Checkpoint* start, const UseSummary& summary) {
  if (start == nullptr) return true;
  const std::uint64_t triangles = start->place.triangles;
  return triangles == summary.triangle_count || triangles % summary.block_triangles == 0;
}

struct FoundUses {
  std::optional<LastUse> uses;
  bool of_sidecar = false;
};

// Takes the last uses from the sidecar if there is one that fits, and if it may be used; else from scan().
FoundUses find_last_uses(RunContext& run, const MeshInput& input, IndexedMesh& mesh, const Checkpoint* start,
                         bool use_sidecar, std::vector<std::string>& notes) {
  const bool may_give_up = run.options.may_reorder && start == nullptr;
  const std::string sidecar = sidecar_path(run, input);
  if (sidecar.empty()) return {scan(run, mesh, start, may_give_up)};
  const MeshIdentity identity = identify_mesh(input.path);
  SidecarLoad known;
  if (use_sidecar)
    known = load_sidecar(sidecar, identity, mesh.vertex_count(), run.temp, run.budget, run.plan.table_bytes);
  const auto is_usable = [&](const UseSummary& uses) {
    return can_start(start, uses) && !run.plan.exceeds(needs(run, uses));
  };
  if (known.uses && is_usable(known.uses->summary())) return {std::move(known.uses), true};
  if (!known.note.empty()) notes.push_back(known.note);
  known.uses.reset();
  std::optional<LastUse> uses = scan(run, mesh, start, may_give_up && !run.options.keep_sidecar);
  if (uses && run.options.keep_sidecar) {
    if (input.check_unchanged) input.check_unchanged();
    save_sidecar(sidecar, identity, *uses);
  }
  return {std::move(uses)};
}

std::unique_ptr<ReorderedMesh> sort_on_disk(RunContext& run, IndexedMesh& mesh, unsigned dimension) {
  constexpr std::uint64_t kSortBytesLimit = 64u << 20;
  return reorder(mesh, run.temp, run.budget,
                 {.allowance_bytes = std::min<std::uint64_t>(run.budget.free_bytes() / 2, kSortBytesLimit),
                  .coordinates = std::min(dimension, 3u),
                  .threads = run.options.threads,
                  .progress = [&run](double done) { tell_sorting(run, kSorted * done); }});
}

// The content of the sidecar is not that of the mesh.
struct WrongSidecar {};

// THROWS: WrongSidecar, if one may be used.
FirstStageResult run_once(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh>& mesh,
                          const Checkpoint* start, bool use_sidecar, FirstStageResult result) {
  FoundUses found;
  std::optional<LastUse>& uses = found.uses;
  const bool was_sorted = start != nullptr && start->origin == ChunkOrigin::kSorted;
  if (!was_sorted) {
    const Stopwatch watch;
    found = find_last_uses(run, input, *mesh, start, use_sidecar, result.notes);
    result.seconds.finalization += watch.seconds();
  }
  // A run that is resumed keeps the order in which it began.
  result.reordered =
      start != nullptr ? was_sorted : run.options.may_reorder && !(uses && is_coherent(run, uses->summary()));
  if (result.reordered) {
    const Stopwatch watch;
    result.notes.push_back("neighbouring triangles lie far apart in this file, so they were sorted on disk first");
    found = {};
    auto sorted = sort_on_disk(run, *mesh, input.dimension);
    result.spilled_bytes += sorted->spilled_bytes();
    append(result.notes, mesh->warnings());
    mesh = std::move(sorted);
    uses = scan(run, *mesh, start, false, true);
    result.seconds.reorder += watch.seconds();
  }
  const UseSummary& summary = uses->summary();
  result.unused_vertices = summary.unused_vertices;
  result.degenerate_triangles = summary.degenerate_triangles;
  result.spilled_bytes += uses->spilled_bytes();
  const MemoryPlan plan = plan_for(run, summary);
  const Checkpoint here{.block_triangles = summary.block_triangles,
                        .origin = result.reordered ? ChunkOrigin::kSorted : ChunkOrigin::kLookedUp};
  try {
    const auto source = chunks_of(*mesh, *uses, run.values, plan.chunk, place_of(start));
    result = glue_chunks(run, *source, plan, here, std::move(result));
  } catch (const InputChanged&) {
    if (found.of_sidecar) throw WrongSidecar();
    throw;
  }
  append(result.notes, mesh->warnings());
  return result;
}

// `mesh` is the mesh of the input, or was spooled from it.
FirstStageResult run_indexed(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh> mesh,
                             const Checkpoint* start, FirstStageResult result) {
  const Reservation values = prepare_values(run, mesh->vertex_count());
  const FirstStageResult before = result;
  try {
    return run_once(run, input, mesh, start, true, std::move(result));
  } catch (const WrongSidecar&) {
    if (input.check_unchanged) input.check_unchanged();
    result = before;
  }
  run.start_over();
  result.notes.push_back(ignored_sidecar(sidecar_path(run, input), "its content is not that of the mesh"));
  return run_once(run, input, mesh, nullptr, false, std::move(result));
}

}  // namespace

// An indexed mesh can be looked up. A stream is glued as it comes, unless that takes too much memory. Any other mesh is
// spooled. Guesses can suffice to glue it meanwhile; if not, it is then run as an indexed mesh.
FirstStageResult run_first_stage(RunContext& run, MeshInput input) {
  for (const std::string& output : run.outputs) io::remove_abandoned(output);
  FirstStageResult result;
  const auto restore = [&run](StateReader& in) {
    check_ranges(run.resumable.checkpoint()->place.ranges, run.functions.size());
    run.restore_stores(in);
  };
  const Checkpoint* start = run.resumable.start(restore, result.notes);
  // An earlier run may have written outputs only if this one continues it.
  if (!run.options.replace && !run.resumable.was_resumed())
    for (const std::string& output : run.outputs) io::check_output_name(output, io::Existing::kRefuse);
  if (input.indexed) return run_indexed(run, input, std::move(input.indexed), start, std::move(result));

  input.reader = std::make_unique<PolledReader>(std::move(input.reader), run.resumable);
  if (input.reader->info().finalizes && (start == nullptr || start->origin == ChunkOrigin::kStream)) {
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

}  // namespace reeb::ooc
