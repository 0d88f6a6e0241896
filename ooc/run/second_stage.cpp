#include "ooc/run/second_stage.h"

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/base/work.h"
#include "libreeb/defects/small_loops.h"
#include "libreeb/hierarchy/cancel.h"
#include "ooc/reeb_writer/record_log.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "ooc/run/freed_memory.h"
#include "ooc/run/graph_file.h"
#include "ooc/run/stopwatch.h"
#include "ooc/stored_graph/last_noise_pass.h"
#include "ooc/stored_graph/load_graph.h"
#include "ooc/stored_graph/segment_store.h"
#include "ooc/stored_hierarchy/stored_hierarchy.h"
#include "ooc/threads/thread_turns.h"
#include "ooc/threads/worker.h"

namespace reeb::ooc {
namespace {

// The share of the whole stage that its parts take, about: they are not alike for all graphs.
constexpr double kLoaded = 0.15, kBuilt = 0.8;

// Empty if the run has no second thread.
DoBoth in_two_threads(const RunContext& run) {
  if (!run.background()) return {};
  return [worker = std::make_shared<Worker>()](const auto& here, const auto& elsewhere) {
    worker->do_both(here, elsewhere);
  };
}

// ---- noise

struct LastNoise {
  std::uint64_t removed_pairs = 0, spilled_bytes = 0;
};

// Removes the noise that the first stage left. If memory does not suffice, the graph stays as it is and the user is
// told.
LastNoise remove_last_noise(RunContext& run, StoredGraph& graph) {
  SegmentStore& store = *graph.store;
  LastNoisePass pass = run_last_noise_pass(store, run.temp,
                                           {.threshold = graph.sweep.noise_below,
                                            .bucket_exponent = graph.sweep.bucket_exponent,
                                            .vertices = graph.vertex_bound,
                                            .change_bytes = run.plan.segment_bytes});
  if (!pass.fits) {
    FileMeta meta = graph.meta;
    meta.denoise_threshold = 0;
    write_graph(run, graph, meta);
    throw no_memory_for(run, "the last pass of noise removal", graph.output, store.arc_count(),
                        {pass.needed_bytes, pass.needed_bytes}, "leave out --denoise");
  }
  if (!pass.change) return {pass.removed_pairs};
  const std::uint64_t change_bytes = pass.change->reserved_bytes(), changed_arcs = pass.change->arcs->size(),
                      spilled_bytes = pass.change->arcs->spilled_bytes();
  store.apply(std::move(*pass.change));
  // A change of more than this share of the graph, or of memory, takes more memory than reading the changed graph.
  constexpr std::uint64_t kSmallShare = 8;
  const bool is_small =
      kSmallShare * changed_arcs <= store.arc_count() && kSmallShare * change_bytes <= run.budget.free_bytes();
  if (change_bytes <= run.plan.segment_bytes || is_small) return {pass.removed_pairs, spilled_bytes};
  const auto poll = [&run] { run.resumable.check_interruption(); };
  auto changed = std::make_unique<SegmentStore>(run.temp, run.budget,
                                                SegmentOptions{.allowance_bytes = run.plan.segment_bytes,
                                                               .most_bytes = run.plan.most_segment_bytes,
                                                               .background = run.background(),
                                                               .poll = poll});
  copy_graph(store, *changed, graph.sweep.bucket_exponent, poll);
  changed->finish();
  graph.store = std::move(changed);
  return {pass.removed_pairs, spilled_bytes + graph.store->spilled_bytes()};
}

// ---- the hierarchy

struct WrittenHierarchy {
  BettiNumbers betti;
  std::array<std::uint64_t, 4> pairs{};  // by PairType
  std::uint64_t kept_loops = 0;
  std::vector<Feature> largest;
  SmallLoops likely_defects{};
  std::uint64_t spilled_bytes = 0;
};

// What is reported of the pairs: their numbers, and the largest loops, and the largest minima and maxima, of each at
// most kMostFeatures.
void look_at_pairs(HierarchySource& hierarchy, double range, WrittenHierarchy& written) {
  struct Last {
    std::uint64_t number;
    PersistencePair pair;
  };
  std::array<std::deque<Last>, 2> last;  // loops, and others
  LikelyDefects defects(range);
  const auto persistence = [&](const PersistencePair& pair) {
    return hierarchy.key(pair.hi).value - hierarchy.key(pair.lo).value;
  };
  hierarchy.rewind_pairs();
  std::uint64_t number = 0;
  for (PersistencePair pair; hierarchy.next_pair(pair); ++number) {
    ++written.pairs[static_cast<std::size_t>(pair.type)];
    written.kept_loops += pair.kept ? 1u : 0u;
    if (pair.type == PairType::kExt1) defects.add(persistence(pair));
    if (pair.type == PairType::kExt0) continue;
    std::deque<Last>& largest = last[pair.type == PairType::kExt1 ? 0 : 1];
    largest.push_back({number, pair});
    if (largest.size() > kMostFeatures) largest.pop_front();
  }
  written.likely_defects = defects.found();
  std::vector<Last> largest(last[0].begin(), last[0].end());
  largest.insert(largest.end(), last[1].begin(), last[1].end());
  std::ranges::sort(largest, std::greater<>(), &Last::number);
  for (const Last& one : largest)
    if (persistence(one.pair) > 0)
      written.largest.push_back({one.pair.type, hierarchy.key(one.pair.lo), hierarchy.key(one.pair.hi)});
}

struct GraphInMemory {
  LoadedGraph loaded;
  std::uint64_t more_bytes = 0;  // that pairing and cancelling take in addition
};

// The log of a hierarchy in memory.
std::uint64_t log_bytes(std::uint64_t arcs) { return RecordLog::memory_bytes(RecordLog::block_bytes(arcs)); }

// The most memory that a hierarchy in memory takes.
std::uint64_t bytes_in_memory(const StoredGraph& graph) {
  const std::uint64_t arcs = graph.store->arc_count();
  std::optional<std::uint64_t> lists;
  if (graph.sweep.bucket_exponent) lists = PackedLists::most_bytes(arcs, graph.store->bucket_count());
  return hierarchy_bytes(graph.store->node_count(), arcs, lists) + log_bytes(arcs);
}

// The hierarchy cannot be made: writes the graph as it is, and tells the user. With `least` bytes it can be tried
// again.
[[noreturn]] void refuse_hierarchy(RunContext& run, const StoredGraph& graph, std::uint64_t least) {
  const std::uint64_t most = bytes_in_memory(graph);
  write_graph(run, graph, graph.meta);
  throw no_memory_for(run, "the hierarchy", graph.output, graph.store->arc_count(), {std::min(least, most), most},
                      "remove noise with --denoise, or compute the graph alone with --graph-only");
}

// Pairing and cancelling hold the graph in memory, but not their results. Nothing if it does not fit.
std::optional<GraphInMemory> load_for_hierarchy(RunContext& run, const StoredGraph& graph) {
  SegmentStore& store = *graph.store;
  const std::uint64_t nodes = store.node_count(), arcs = store.arc_count();
  const LoadOptions loading{.bucket_exponent = graph.sweep.bucket_exponent};
  // Most of what is needed is known before anything is read.
  const std::uint64_t room = run.budget.free_bytes() + store.reserved_bytes();
  std::optional<std::uint64_t> lists;
  if (run.embeds()) lists = 0;
  if (loading_bytes(store, loading) > run.budget.free_bytes() || hierarchy_bytes(nodes, arcs, lists) > room) return {};
  const Poll poll = stage_poll(run);
  LoadedGraph loaded = read_graph(store, loading, part_of(poll, 0, kLoaded));
  if (run.embeds()) lists = loaded.buckets.memory_bytes();
  const std::uint64_t needed = hierarchy_bytes(nodes, arcs, lists) + log_bytes(arcs);
  const std::uint64_t more = needed - loaded.memory.bytes();
  if (more > run.budget.free_bytes() + store.reserved_bytes()) return {};
  return GraphInMemory{std::move(loaded), more};
}

// What a run records of a hierarchy, and its file.
void write_file(RunContext& run, const StoredGraph& stored, HierarchySource& hierarchy, RecordLog& records,
                WrittenHierarchy& written) {
  // The range may be beyond the doubles.
  look_at_pairs(hierarchy,
                std::min(stored.meta.function_max - stored.meta.function_min, std::numeric_limits<double>::max()),
                written);
  written.betti = {written.pairs[static_cast<std::size_t>(PairType::kExt0)],
                   written.pairs[static_cast<std::size_t>(PairType::kExt1)]};
  const Poll poll = stage_poll(run);
  write_hierarchy_file(stored.output, stored.meta,
                       {hierarchy, records, run.embeds(), run.background(), run.output_options()},
                       part_of(poll, kBuilt, 1));
  written.spilled_bytes = records.spilled_bytes();
}

// Pairs and cancels on disk, and writes the file. If it cannot be done, returns the memory with which it might.
std::optional<std::uint64_t> make_on_disk(RunContext& run, const StoredGraph& stored, std::uint64_t least,
                                          WrittenHierarchy& written) {
  SegmentStore& store = *stored.store;
  RecordLog records(run.temp, run.budget, RecordLog::kBlockBytes, run.background());
  StoredHierarchy hierarchy(store, run.temp, run.budget,
                            {.bucket_exponent = stored.sweep.bucket_exponent, .background = run.background()});
  const Poll poll = stage_poll(run);
  const double paired = (kLoaded + kBuilt) / 2;
  hierarchy.pair_nodes(part_of(poll, 0, paired));
  const std::uint64_t writing = hierarchy_file_bytes(store.node_count(), hierarchy.pair_count());
  const std::uint64_t steps = sizeof(double) * hierarchy.pair_count();
  const std::uint64_t needed = writing + steps + hierarchy.writing_bytes();
  if (needed > run.budget.free_bytes() + hierarchy.table_bytes()) return least + needed;
  if (!hierarchy.cancel(records, part_of(poll, paired, kBuilt))) return bytes_in_memory(stored);
  const Reservation memory = run.budget.reserve("layout of the file", writing);
  write_file(run, stored, hierarchy, records, written);
  written.spilled_bytes += hierarchy.spilled_bytes();
  return {};
}

// The same. If it does not fit, from the start or in the middle, or the graph has no locality, the graph is written as
// it is and the user is told.
WrittenHierarchy write_stored_hierarchy(RunContext& run, const StoredGraph& stored) {
  return_freed_memory();
  const std::uint64_t least = StoredHierarchy::least_bytes(stored.store->node_count()) + RecordLog::memory_bytes();
  if (least > run.budget.free_bytes()) refuse_hierarchy(run, stored, least);
  WrittenHierarchy written;
  std::optional<std::uint64_t> needed;
  const std::uint64_t refusals = run.budget.refusals();
  try {
    needed = make_on_disk(run, stored, least, written);
  } catch (const Error& error) {
    // If it was the disk, there is no use in trying again.
    if (error.kind() != ErrorKind::kResource || run.budget.refusals() == refusals) throw;
    needed = bytes_in_memory(stored);
  }
  if (needed) refuse_hierarchy(run, stored, *needed);
  return written;
}

WrittenHierarchy write_hierarchy(RunContext& run, StoredGraph stored) {
  std::optional<GraphInMemory> loaded = load_for_hierarchy(run, stored);
  if (!loaded) return write_stored_hierarchy(run, stored);
  GraphInMemory& in_memory = *loaded;
  stored.store.reset();
  ReebGraph& graph = in_memory.loaded.graph;
  const std::uint64_t arcs = graph.arc_count();
  RecordLog records(run.temp, run.budget, RecordLog::block_bytes(arcs), run.background());
  const Reservation memory = run.budget.reserve("hierarchy", in_memory.more_bytes - log_bytes(arcs));

  WrittenHierarchy written;
  const Poll poll = stage_poll(run);
  ThreadTurns turns;
  const Hierarchy hierarchy =
      build_hierarchy(graph, std::move(in_memory.loaded.buckets), stored.meta.bucket_exponent, records,
                      {.poll = part_of(poll, kLoaded, kBuilt), .both = in_two_threads(run), .turns = &turns});
  HierarchyInMemory source(graph, hierarchy);
  write_file(run, stored, source, records, written);
  return written;
}

// ---- all of it

// The results of the first stage for a function.
ComputeResult result_of(const RunContext& run, const FirstStageResult& first, std::size_t function) {
  ComputeResult result;
  result.function = run.functions[function]->name();
  result.output = run.outputs[function];
  if (first.vertices != 0)
    result.range = run.values.range(function);
  else
    result.range = {0, 0};
  result.vertices = first.vertices;
  result.unused_vertices = first.unused_vertices;
  result.simplices = first.simplices;
  result.degenerate_triangles = first.degenerate_triangles;
  result.denoised_pairs = first.removed_pairs[function];
  result.reordered = first.reordered;
  result.guessed_vertices = first.guessed_vertices;
  result.revoked_guesses = first.revoked_guesses;
  result.spilled_bytes = first.spilled_bytes;
  result.threads = run.threads;
  result.live = first.live;
  result.seconds = first.seconds;
  result.notes = first.notes;
  return result;
}

FileMeta file_meta(const ComputeResult& result, const SweepOptions& sweep) {
  FileMeta meta;
  meta.function = result.function;
  meta.function_min = result.range.min;
  meta.function_max = result.range.max;
  meta.mesh_vertices = result.vertices;
  meta.mesh_triangles = result.triangles();
  meta.denoise_threshold = sweep.noise_below;
  meta.denoised_pairs = result.denoised_pairs;
  meta.bucket_exponent = sweep.bucket_exponent.value_or(0);
  return meta;
}

}  // namespace

ComputeResult run_second_stage(RunContext& run, const FirstStageResult& first, std::size_t function) {
  ComputeResult result = result_of(run, first, function);
  const SweepOptions sweep = sweep_options(run.options, result.range);
  StoredGraph graph{std::move(run.stores[function]), result.output, sweep, file_meta(result, sweep),
                    first.vertex_bound};
  run.tell({ComputeProgress::Phase::kHierarchy});
  const Stopwatch watch;
  graph.store->finish();
  result.spilled_bytes += graph.store->spilled_bytes();
  require_numbers(graph.store->node_count(), graph.store->arc_count(), graph.output);
  if (run.options.denoise > 0) {
    const LastNoise noise = remove_last_noise(run, graph);
    result.spilled_bytes += noise.spilled_bytes;
    result.denoised_pairs += noise.removed_pairs;
    graph.meta.denoised_pairs = result.denoised_pairs;
    return_freed_memory();
  }
  result.nodes = graph.store->node_count();
  result.arcs = graph.store->arc_count();
  if (run.options.graph_only) {
    const WrittenGraph written = write_graph(run, graph, graph.meta);
    result.betti = written.betti;
    result.spilled_bytes += written.spilled_bytes;
  } else {
    WrittenHierarchy written = write_hierarchy(run, std::move(graph));
    result.betti = written.betti;
    result.pairs = written.pairs;
    result.kept_loops = written.kept_loops;
    result.largest = std::move(written.largest);
    result.likely_defects = written.likely_defects.count;
    result.likely_defects_up_to = written.likely_defects.persistence;
    result.spilled_bytes += written.spilled_bytes;
  }
  result.seconds.hierarchy += watch.seconds();
  result.seconds.wall += watch.seconds();
  return result;
}

}  // namespace reeb::ooc
