#include "ooc/run/compute.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "io/file/atomic_file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/engine/sweep_options.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/hierarchy/cancel.h"
#include "ooc/chunks/coherence.h"
#include "ooc/chunks/divided_chunks.h"
#include "ooc/chunks/guessed_chunks.h"
#include "ooc/chunks/last_use.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/reeb_file/record_log.h"
#include "ooc/reeb_file/reeb_file_writer.h"
#include "ooc/run/memory_plan.h"
#include "ooc/run/resumable_run.h"
#include "ooc/stored_graph/last_noise_pass.h"
#include "ooc/stored_graph/segment_store.h"
#include "ooc/threads/read_ahead.h"
#include "ooc/whole_mesh/reorder.h"

namespace reeb::ooc {
namespace {

using Clock = std::chrono::steady_clock;
using Phase = ComputeProgress::Phase;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Measures a scope.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += seconds_since(start_); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

// What a stage has freed lies in small pieces, which the next one, with pieces of other sizes, would be
// piled upon.
void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// The path of a mesh that a later process can read in the same way.
std::string readable_again(const MeshInput& input) { return input.may_resume && input.path != "-" ? input.path : ""; }

class Run {
 public:
  Run(MeshInput input, std::span<VertexFunction* const> functions, std::span<const std::string> outputs,
      const ComputeOptions& options)
      : functions_(functions),
        outputs_(outputs),
        options_(options),
        plan_(plan_memory({.limit_bytes = options.memory_bytes,
                           .threads = options.threads,
                           .functions = functions.size(),
                           .chunk_triangles = options.chunk_triangles,
                           .stretch_triangles = options.stretch_triangles,
                           .in_place = input.indexed != nullptr,
                           .embeds = options.buckets != 0,
                           .denoises = options.denoise > 0})),
        budget_(plan_.account_bytes, plan_.set_aside_bytes),
        temp_(options.temp_dir.empty() ? io::TempDir::default_folder(outputs[0]) : options.temp_dir),
        input_(std::move(input)),
        values_(functions, input_.dimension),
        resumable_(outputs[0], readable_again(input_), functions,
                   {options.denoise, options.denoise_is_share, options.buckets},
                   {options.resume, options.checkpoint_seconds, options.interrupted}) {
    make_stores();
  }

  std::vector<ComputeResult> run() try { return run_stages(); } catch (const Error& error) {
    throw resumable_.explain(error);
  } catch (const std::bad_alloc&) {
    throw resumable_.explain(
        Error(ErrorKind::kResource, "out of memory", "close other programs, or allow less with --memory SIZE"));
  }

 private:
  std::vector<ComputeResult> run_stages() {
    {
      const Stopwatch wall(common_.seconds.wall);
      first_stage();
      input_ = {};
    }
    give_back_freed_memory();
    std::vector<ComputeResult> results;
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      results.push_back(second_stage(f));
      stores_[f].reset();
    }
    resumable_.done();
    return results;
  }

  void make_stores();
  void restore_stores(StateReader& in);
  void first_stage();
  void run_stream();
  void run_spooled();
  bool may_guess() const;
  std::unique_ptr<GuessedChunks> guessed_chunks(Spooler& spooler);
  bool run_guessing(GuessedChunks& source);
  void start_anew();
  void run_indexed();
  void note(const std::vector<std::string>& lines) {
    common_.notes.insert(common_.notes.end(), lines.begin(), lines.end());
  }
  ChunkPlace start_place() const;
  std::string sidecar_path() const;
  bool has_sidecar() const;
  std::optional<LastUse> find_last_uses();
  std::optional<LastUse> scan(bool may_give_up);
  FrontNeeds needs(const UseSummary& summary) const;
  bool is_coherent(const UseSummary& summary) const;
  bool can_start(const UseSummary& summary) const;
  std::uint64_t value_bytes(std::uint64_t vertices) const;
  Reservation prepare_values(std::uint64_t vertices);
  void divide_memory(const UseSummary& summary);
  LastUse reorder_mesh();
  void run_chunks(ChunkSource& stretches);

  SweepOptions sweep_options(const FunctionRange& range) const;

  ComputeResult second_stage(std::size_t f);
  FileMeta file_meta(const ComputeResult& result) const;
  bool embeds() const { return options_.buckets != 0; }
  void write_stored_graph(ComputeResult& result, SegmentStore& store, const FileMeta& meta);
  void remove_last_noise(ComputeResult& result, std::unique_ptr<SegmentStore>& store);
  void write_hierarchy(ComputeResult& result, std::unique_ptr<SegmentStore> store);
  Error no_memory_for(const std::string& what, const ComputeResult& result, std::uint64_t needed,
                      const std::string& otherwise) const;
  Error no_memory_for_hierarchy(const ComputeResult& result, std::uint64_t needed) const;
  void tell(Phase phase, std::uint64_t done, std::uint64_t total, std::uint64_t triangles = 0) const {
    if (options_.progress) options_.progress({phase, done, total, triangles});
    if (phase != Phase::kReeb) resumable_.check_interruption();
  }

  std::span<VertexFunction* const> functions_;
  std::span<const std::string> outputs_;
  const ComputeOptions& options_;
  MemoryPlan plan_;
  MemoryBudget budget_;
  io::TempDir temp_;
  MeshInput input_;  // a spooled mesh holds reservations and files of the two above
  FunctionValues values_;
  ResumableRun resumable_;
  const Checkpoint* start_ = nullptr;  // to go on from
  Checkpoint here_;                    // but for the place
  std::vector<std::unique_ptr<SegmentStore>> stores_;
  std::vector<std::uint64_t> removed_pairs_;  // in the first stage, by function
  ComputeResult common_;                      // what all functions share
};

// ---- the first stage: from the mesh to sorted segments

void Run::make_stores() {
  stores_.clear();
  for (std::size_t f = 0; f < functions_.size(); ++f)
    stores_.push_back(std::make_unique<SegmentStore>(
        temp_, budget_,
        SegmentOptions{plan_.segment_bytes, plan_.most_segment_bytes, plan_.threads > 1, resumable_.segments_of(f)}));
}

void Run::restore_stores(StateReader& in) {
  try {
    for (const auto& store : stores_) store->restore(in);
  } catch (...) {
    make_stores();
    throw;
  }
}

void Run::first_stage() {
  for (const std::string& output : outputs_) io::remove_abandoned(output);
  start_ = resumable_.start([this](StateReader& in) { restore_stores(in); }, common_.notes);
  if (input_.indexed)
    run_indexed();
  else if (input_.reader->info().finalizes && (start_ == nullptr || start_->origin == ChunkOrigin::kStream))
    run_stream();
  else
    run_spooled();
}

ChunkPlace Run::start_place() const { return start_ != nullptr ? start_->place : ChunkPlace{}; }

void Run::run_stream() {
  here_.origin = ChunkOrigin::kStream;
  std::optional<std::uint64_t> most_active_vertices;
  if (options_.may_reorder && input_.read_again && start_ == nullptr) most_active_vertices = plan_.most_live_vertices();
  auto source = chunks_of(*input_.reader, values_, plan_.chunk, start_place(), most_active_vertices);
  run_chunks(*source);
  if (source->given_up()) {
    common_.notes.push_back("too many vertices of the stream are live at once, so it was read again from the start");
    start_anew();
    source.reset();
    input_.reader = input_.read_again();
    return run_spooled();
  }
  for (VertexFunction* function : functions_) function->check_count(common_.vertices);
  note(input_.reader->warnings());
}

// A mesh that is read once, and kept on disk for what cannot be done while it is read: in one pass if
// guesses hold, else to be run from there.
void Run::run_spooled() {
  bool guessing = false;  // then progress is told by chunk
  SpoolOptions options;
  options.allowance_bytes = plan_.table_bytes;
  options.progress = [&](const MeshReader& reader) {
    if (!guessing) tell(Phase::kSpool, reader.bytes_read(), reader.info().file_bytes);
  };
  std::optional<Spooler> spooler(std::in_place, *input_.reader, temp_, budget_, options);
  bool done = false;
  if (may_guess()) {
    const auto source = guessed_chunks(*spooler);
    guessing = true;
    done = run_guessing(*source);
    guessing = false;
  }
  {
    const Stopwatch watch(common_.seconds.finalization);
    auto mesh = spooler->finish();
    common_.spilled_bytes += mesh->spilled_bytes();
    input_.indexed = std::move(mesh);
  }
  note(input_.reader->warnings());
  spooler.reset();
  input_.reader.reset();
  if (!done) run_indexed();
}

// Not where the last uses are known, or are to be kept, or where values are looked up in a file, whose
// number is compared with that of the vertices first. A run that goes on keeps to what it began.
bool Run::may_guess() const {
  if (start_ != nullptr) return start_->origin == ChunkOrigin::kGuessed;
  if (!options_.may_guess || options_.keep_sidecar || has_sidecar() || input_.reader->info().finalizes) return false;
  return std::all_of(functions_.begin(), functions_.end(),
                     [](const VertexFunction* function) { return function->source_file().empty(); });
}

std::unique_ptr<GuessedChunks> Run::guessed_chunks(Spooler& spooler) {
  here_.origin = ChunkOrigin::kGuessed;
  if (start_ != nullptr) {
    here_.chunk = start_->chunk;
  } else {
    here_.chunk = plan_.chunk;
  }
  return std::make_unique<GuessedChunks>(
      spooler, values_, temp_, budget_,
      GuessOptions{
          .chunk = here_.chunk, .allowance_bytes = plan_.table_bytes, .most_open_vertices = plan_.most_live_vertices()},
      start_place());
}

// False if it came to nothing.
bool Run::run_guessing(GuessedChunks& source) {
  run_chunks(source);
  const UseGuesses& guesses = source.guesses();
  common_.guessed_vertices = guesses.guessed_vertices();
  common_.revoked_guesses = guesses.revoked_guesses();
  common_.spilled_bytes += guesses.spilled_bytes();
  if (source.given_up()) {
    start_anew();
    return false;
  }
  common_.unused_vertices = guesses.unused_vertices();
  common_.degenerate_triangles = guesses.degenerate_triangles();
  return true;
}

// As if nothing had been run so far.
void Run::start_anew() {
  start_ = nullptr;
  here_ = {};
  make_stores();
  resumable_.start_anew();
  values_.set_ranges(std::vector<FunctionRange>(functions_.size()));
}

void Run::run_indexed() {
  const Reservation values = prepare_values(input_.indexed->vertex_count());
  std::optional<LastUse> last_use;
  const bool was_sorted = start_ != nullptr && start_->origin == ChunkOrigin::kSorted;
  if (!was_sorted) last_use = find_last_uses();
  // A run that goes on keeps to the order in which it began.
  const bool sort_first =
      start_ != nullptr ? was_sorted : options_.may_reorder && !(last_use && is_coherent(last_use->summary()));
  if (sort_first) {
    last_use.reset();
    last_use = reorder_mesh();
  }
  const UseSummary& summary = last_use->summary();
  common_.unused_vertices = summary.unused_vertices;
  common_.degenerate_triangles = summary.degenerate_triangles;
  common_.spilled_bytes += last_use->spilled_bytes();
  here_.block_triangles = summary.block_triangles;
  here_.origin = sort_first ? ChunkOrigin::kSorted : ChunkOrigin::kLookedUp;
  divide_memory(summary);
  run_chunks(*chunks_of(*input_.indexed, *last_use, values_, plan_.chunk, start_place()));
  note(input_.indexed->warnings());
}

// Vertices of an indexed mesh are looked up, for which some functions keep all their values.
Reservation Run::prepare_values(std::uint64_t vertices) {
  Reservation reservation = budget_.reserve("function values", value_bytes(vertices));
  for (VertexFunction* function : functions_) function->check_count(vertices);
  return reservation;
}

std::uint64_t Run::value_bytes(std::uint64_t vertices) const {
  std::uint64_t bytes = 0;
  for (const VertexFunction* function : functions_) bytes += function->lookup_bytes(vertices);
  return bytes;
}

FrontNeeds Run::needs(const UseSummary& summary) const {
  return {summary.vertex_count, summary.max_live_vertices, value_bytes(summary.vertex_count)};
}

// Whether to glue the mesh as it comes. A front that does not fit is sorted if it can be expected to
// come out smaller.
bool Run::is_coherent(const UseSummary& summary) const {
  constexpr double kSorted = 2;
  const auto sorted = static_cast<std::uint64_t>(kSorted * std::sqrt(static_cast<double>(summary.vertex_count)));
  if (!plan_.fits(needs(summary))) return summary.max_live_vertices <= sorted;
  MemoryPlan plan = plan_;
  plan.share_out(needs(summary));
  return summary.max_live_vertices <= usual_front(summary.vertex_count, plan.chunk.most);
}

// Now that the front is known: to the chunks what the live graphs leave. Says at once if they cannot
// fit.
void Run::divide_memory(const UseSummary& summary) {
  const FrontNeeds front = needs(summary);
  if (plan_.exceeds(front)) {
    const std::string megabytes = std::to_string((plan_.needed_bytes(front) >> 20) + 1) + "M";
    throw Error(ErrorKind::kResource,
                std::to_string(front.live_vertices) + " vertices are live at once, and their graph will not fit " +
                    format_bytes(plan_.set_aside_bytes + plan_.account_bytes) + " of memory",
                "allow --memory " + megabytes +
                    (options_.may_reorder ? "" : ", or let the triangles be sorted (without --no-reorder)"));
  }
  plan_.share_out(front);
}

// Empty if none is used: its blocks are too large for small chunks.
std::string Run::sidecar_path() const {
  const bool has_file = !input_.path.empty() && input_.path != "-" && options_.chunk_triangles == 0;
  return has_file ? input_.path + ".final" : "";
}

bool Run::has_sidecar() const {
  const std::string path = sidecar_path();
  return !path.empty() && io::is_regular_file(path);
}

// From the sidecar if there is one that fits, else by reading the mesh once. Nothing if the mesh
// turns out to be so incoherent that it will be reordered anyway.
std::optional<LastUse> Run::find_last_uses() {
  const Stopwatch watch(common_.seconds.finalization);
  const bool may_give_up = options_.may_reorder && start_ == nullptr;
  const std::string sidecar = sidecar_path();
  if (sidecar.empty()) return scan(may_give_up);
  const MeshIdentity identity = identify_mesh(input_.path);
  SidecarLoad known =
      load_sidecar(sidecar, identity, input_.indexed->vertex_count(), temp_, budget_, plan_.table_bytes);
  if (known.uses && can_start(known.uses->summary())) return std::move(known.uses);
  if (!known.note.empty()) common_.notes.push_back(known.note);
  std::optional<LastUse> uses = scan(may_give_up && !options_.keep_sidecar);
  if (uses && options_.keep_sidecar) save_sidecar(sidecar, identity, *uses);
  return uses;
}

// Whether the place to go on from is at the end of a block.
bool Run::can_start(const UseSummary& summary) const {
  if (start_ == nullptr) return true;
  const std::uint64_t triangles = start_->place.triangles;
  return triangles == summary.triangle_count || triangles % summary.block_triangles == 0;
}

std::optional<LastUse> Run::scan(bool may_give_up) {
  LastUseOptions options;
  options.allowance_bytes = plan_.table_bytes;
  options.give_up_when_incoherent = may_give_up;
  // A chunk is whole blocks, so small chunks need small blocks.
  options.block_triangles = std::min<std::uint64_t>(options.block_triangles, plan_.chunk.first);
  if (start_ != nullptr) options.block_triangles = start_->block_triangles;
  options.threads = plan_.threads;
  options.progress = [this, total = input_.indexed->bytes_total()](std::uint64_t bytes_read) {
    tell(Phase::kFinalization, bytes_read, total);
  };
  return scan_last_use(*input_.indexed, temp_, budget_, options);
}

LastUse Run::reorder_mesh() {
  const Stopwatch watch(common_.seconds.reorder);
  common_.notes.push_back("the triangles are in no coherent order, so they were sorted on disk first");
  common_.reordered = true;
  tell(Phase::kReorder, 0, 0);
  ReorderOptions options;
  options.allowance_bytes = std::min<std::uint64_t>(budget_.free_bytes() / 2, 64u << 20);
  options.coordinates = std::min(input_.dimension, 3u);
  auto mesh = reorder(*input_.indexed, temp_, budget_, options);
  common_.spilled_bytes += mesh->spilled_bytes();
  note(input_.indexed->warnings());
  input_.indexed = std::move(mesh);
  return std::move(*scan(false));
}

void Run::run_chunks(ChunkSource& stretches) {
  const Stopwatch watch(common_.seconds.reeb);
  const std::size_t whole = plan_.chunk.first + plan_.chunk.first / 4;  // the last batch of a stream goes beyond
  DividedChunks source(stretches, whole, plan_.chunk.patch, budget_);
  std::vector<GraphSink*> sinks;
  for (const auto& store : stores_) sinks.push_back(store.get());
  PipelineOptions options;
  options.threads = plan_.threads;
  options.choose_sweep = [this](std::size_t, const FunctionRange& range) { return sweep_options(range); };
  options.progress = [this](const SourceProgress& at) {
    tell(Phase::kReeb, at.bytes_read, at.bytes_total, at.triangles_read);
  };
  options.between_chunks = [this](const ChunkPlace& place, const SaveEngine& save_engine) {
    here_.place = place;
    resumable_.between_chunks(here_, [&](StateWriter& out) {
      for (const auto& store : stores_) store->save(out);
      save_engine(out);
    });
  };
  options.saved_engine = resumable_.saved_engine();
  PipelineResult done = run_pipeline(source, sinks, budget_, options);
  common_.live = done.live;
  removed_pairs_ = std::move(done.removed_pairs);
  common_.triangles = source.triangles_read();
  common_.vertices = source.vertex_count();
}

// From the range of values so far, which only grows: what is noise below a share of it, is noise.
SweepOptions Run::sweep_options(const FunctionRange& range) const {
  SweepOptions sweep;
  sweep.noise_below = options_.denoise_is_share ? range.part(options_.denoise) : options_.denoise;
  if (embeds()) sweep.bucket_exponent = bucket_exponent(range.min, range.max, options_.buckets);
  return sweep;
}

// ---- the second stage: from segments to the file

ComputeResult Run::second_stage(std::size_t f) {
  ComputeResult result = common_;
  std::unique_ptr<SegmentStore>& store = stores_[f];
  result.function = functions_[f]->name();
  result.output = outputs_[f];
  result.range = values_.range(f);
  if (result.vertices == 0) result.range = {0, 0};
  result.nodes = store->node_count();
  result.arcs = store->arc_count();
  result.denoised_pairs = removed_pairs_[f];
  tell(Phase::kHierarchy, 0, 0);
  const auto start = Clock::now();
  {
    const Stopwatch watch(result.seconds.hierarchy);
    store->finish();
    result.spilled_bytes += store->spilled_bytes();
    if (options_.denoise > 0) {
      remove_last_noise(result, store);
      give_back_freed_memory();
    }
    if (options_.graph_only)
      write_stored_graph(result, *store, file_meta(result));
    else
      write_hierarchy(result, std::move(store));
  }
  result.seconds.wall += seconds_since(start);
  return result;
}

FileMeta Run::file_meta(const ComputeResult& result) const {
  FileMeta meta;
  meta.function = result.function;
  meta.function_min = result.range.min;
  meta.function_max = result.range.max;
  meta.mesh_vertices = result.vertices;
  meta.mesh_triangles = result.triangles;
  const SweepOptions sweep = sweep_options(result.range);
  meta.denoise_threshold = sweep.noise_below;
  meta.denoised_pairs = result.denoised_pairs;
  meta.bucket_exponent = sweep.bucket_exponent.value_or(0);
  return meta;
}

// The graph as it was stored, in memory that need not grow with it. Where memory is free, 4 bytes a node, and 4 bytes
// a vertex if there is much to look up.
void Run::write_stored_graph(ComputeResult& result, SegmentStore& store, const FileMeta& meta) {
  constexpr std::size_t kNodes = 16384, kBytesAnArc = 1000, kManyVerticesANode = 16;
  GraphFileWriter::Options writing{.nodes = result.nodes,
                                   .has_embedding = embeds(),
                                   .ends = GraphFileWriter::ArcEnds::kKeys,
                                   .background = plan_.threads > 1,
                                   .temp = &temp_,
                                   .budget = &budget_};
  const std::uint64_t table_bytes = result.vertices * sizeof(std::uint32_t);
  Reservation table;
  if (result.vertices / kManyVerticesANode <= result.nodes && table_bytes <= budget_.free_bytes() / 4) {
    table = budget_.reserve("ranks of nodes", table_bytes);
    writing.ends = GraphFileWriter::ArcEnds::kKeysInMemory;
  }
  GraphFileWriter writer(result.output, meta, writing);
  // Large pieces are for the lookup in a file.
  const std::size_t pieces =
      table.bytes() != 0 ? 8192 : std::clamp<std::size_t>(budget_.free_bytes() / kBytesAnArc, 4096, 65536);
  store.rewind_nodes();
  read_ahead<std::vector<SettledNode>>(
      writing.background, [&](auto& nodes) { return store.read_nodes(nodes, kNodes); },
      [&](const auto& nodes) { writer.add_nodes(nodes); });
  store.rewind_arcs();
  const std::optional<int> exponent = sweep_options(result.range).bucket_exponent;
  read_ahead<ArcPiece>(
      writing.background, [&](ArcPiece& piece) { return store.read_arcs(piece, pieces, exponent); },
      [&](const ArcPiece& piece) { writer.add_arcs(piece.arcs, piece.buckets.view()); });
  writer.finish();
  result.betti = {writer.header().components, writer.header().loops};
  result.spilled_bytes += writer.spilled_bytes();
}

// What was left of the noise on the way goes here. Where memory does not suffice, the graph is kept as
// it is and the user is told.
void Run::remove_last_noise(ComputeResult& result, std::unique_ptr<SegmentStore>& store) {
  const SweepOptions sweep = sweep_options(result.range);
  LastNoisePass pass = run_last_noise_pass(
      *store, {.threshold = sweep.noise_below, .bucket_exponent = sweep.bucket_exponent, .vertices = result.vertices});
  if (!pass.fits) {
    FileMeta meta = file_meta(result);
    meta.denoise_threshold = 0;
    write_stored_graph(result, *store, meta);
    throw no_memory_for("the last pass of noise removal", result, pass.needed_bytes, "do without --denoise");
  }
  result.denoised_pairs += pass.removed_pairs;
  if (!pass.patch) return;
  const std::uint64_t patch_bytes = pass.patch->memory.bytes(), changed_arcs = pass.patch->arcs.records.size();
  store->apply(std::move(*pass.patch));
  result.nodes = store->node_count();
  result.arcs = store->arc_count();
  // A change of much of the graph takes more memory than reading the graph that it leaves.
  constexpr std::uint64_t kMuch = 8;
  const bool is_little = kMuch * changed_arcs <= result.arcs && kMuch * patch_bytes <= budget_.free_bytes();
  if (patch_bytes <= plan_.segment_bytes || is_little) return;
  auto changed = std::make_unique<SegmentStore>(temp_, budget_,
                                                SegmentOptions{.allowance_bytes = plan_.segment_bytes,
                                                               .most_bytes = plan_.most_segment_bytes,
                                                               .background = plan_.threads > 1});
  copy_graph(*store, *changed, sweep.bucket_exponent);
  changed->finish();
  result.spilled_bytes += changed->spilled_bytes();
  store = std::move(changed);
}

Error Run::no_memory_for(const std::string& what, const ComputeResult& result, std::uint64_t needed,
                         const std::string& otherwise) const {
  // Reading what is stored takes up to a quarter of the account.
  const std::uint64_t enough = plan_.set_aside_bytes + (budget_.used_bytes() + needed) / 3 * 4;
  Error error(ErrorKind::kResource,
              what + " of " + std::to_string(result.arcs) + " arcs needs up to " + format_bytes(needed) +
                  " of memory, but only " + format_bytes(budget_.free_bytes()) +
                  " are left; the graph itself was written",
              "allow --memory " + std::to_string(enough / (1 << 20) + 1) + "M, or " + otherwise);
  error.at(result.output);
  return error;
}

Error Run::no_memory_for_hierarchy(const ComputeResult& result, std::uint64_t needed) const {
  return no_memory_for("the hierarchy", result, needed,
                       "remove noise with --denoise, or keep to the graph with --graph-only");
}

// Pairing and cancelling hold the graph in memory, though not what they make of it. Where that does not
// fit, the graph is kept and the user is told, before the work starts.
void Run::write_hierarchy(ComputeResult& result, std::unique_ptr<SegmentStore> store) {
  const FileMeta meta = file_meta(result);
  const auto refuse = [&](std::uint64_t needed) {
    write_stored_graph(result, *store, meta);
    throw no_memory_for_hierarchy(result, needed);
  };
  const LoadOptions loading{.bucket_exponent = sweep_options(result.range).bucket_exponent};
  if (loading_bytes(*store, loading) > budget_.free_bytes())
    refuse(hierarchy_bytes(result.nodes, result.arcs, PackedLists::most_bytes(result.arcs, store->bucket_count())));
  LoadedGraph loaded = read_graph(*store, loading);
  std::optional<std::uint64_t> lists;
  if (embeds()) lists = loaded.buckets.memory_bytes();
  const std::uint64_t needed = hierarchy_bytes(result.nodes, result.arcs, lists) + RecordLog::memory_bytes();
  const std::uint64_t more = needed - loaded.memory.bytes();
  if (more > budget_.free_bytes() + store->reserved_bytes()) {
    loaded = {};
    refuse(needed);
  }
  store.reset();
  RecordLog records(temp_, budget_);
  const Reservation memory = budget_.reserve("hierarchy", more - RecordLog::memory_bytes());

  ReebGraph& graph = loaded.graph;
  result.betti = betti_numbers(graph);
  const Poll poll = [this] { resumable_.check_interruption(); };
  const Hierarchy hierarchy = build_hierarchy(graph, std::move(loaded.buckets), meta.bucket_exponent, records, poll);
  for (const PersistencePair& pair : hierarchy.pairs) {
    ++result.pairs[static_cast<std::size_t>(pair.type)];
    result.kept_loops += pair.kept ? 1u : 0u;
  }
  constexpr std::size_t kLargest = 5;
  for (auto it = hierarchy.pairs.rbegin(); it != hierarchy.pairs.rend() && result.largest.size() < kLargest; ++it)
    if (it->type != PairType::kExt0)
      result.largest.push_back({it->type, graph.nodes[it->lo.value()], graph.nodes[it->hi.value()]});
  write_hierarchy_file(result.output, meta, {graph, hierarchy, records, embeds(), plan_.threads > 1}, poll);
  result.spilled_bytes += records.spilled_bytes();
}

}  // namespace

std::vector<ComputeResult> compute(MeshInput input, std::span<VertexFunction* const> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  for (const std::string& output : outputs) io::require_output_folder(output);
  return Run(std::move(input), functions, outputs, options).run();
}

}  // namespace reeb::ooc
