// The second stage, from a graph in memory to its file: time and peak bytes per arc.
//
// Arguments: kind of graph, arcs, buckets over the range (0: no embedding). The peak counts the graph with its buckets
// and everything allocated later by operator new. Arc records go to a log on disk. Ten million arcs are left out unless
// REEB_BENCH_LARGE is set in the environment.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/cancel.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/reeb_writer/record_log.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/support/held_memory.h"
#include "tests/support/inputs/made_graph.h"
#include "tests/support/inputs/random_function_graph.h"

namespace {

using namespace reeb;
using namespace reeb::bench;

constexpr std::int64_t kRandomFunction = kExpander + 1;

// The data of a run after its first stage.
struct Given {
  ReebGraph graph;
  ArcBuckets buckets;
  int exponent = 0;

  ooc::FileMeta meta() const {
    ooc::FileMeta meta;
    meta.function_min = graph.nodes.front().value;
    meta.function_max = graph.nodes.back().value;
    meta.bucket_exponent = exponent;
    meta.mesh_vertices = graph.node_count();
    for (const Bucket& bucket : buckets.buckets) meta.mesh_vertices += bucket.count;
    return meta;
  }
};

const io::TempDir& temp() {
  static const io::TempDir dir;
  return dir;
}

Given make(const benchmark::State& state) {
  const auto arcs = static_cast<std::size_t>(state.range(1));
  const auto buckets = static_cast<std::uint32_t>(state.range(2));
  Given given;
  if (state.range(0) == kRandomFunction) {
    MemoryBudget budget;
    ooc::LoadedGraph loaded = make_random_function_graph(arcs, std::max(buckets, 1u), given.exponent, temp(), budget);
    given.graph = std::move(loaded.graph);
    if (buckets == 0) return given;
    given.buckets.offsets.push_back(0);
    for (std::size_t arc = 0; arc < loaded.buckets.size(); ++arc) {
      unpack_buckets(loaded.buckets.of(arc), given.buckets.buckets);
      given.buckets.offsets.push_back(given.buckets.buckets.size());
    }
    return given;
  }
  given.graph = GraphMaker(static_cast<GraphKind>(state.range(0)), arcs).make();
  for (std::size_t node = 0; node < given.graph.node_count(); ++node)
    given.graph.positions.push_back({static_cast<double>(node % 4096), static_cast<double>(node / 4096), 0});
  if (buckets == 0) return given;
  given.exponent = bucket_exponent(given.graph.nodes.front().value, given.graph.nodes.back().value, buckets);
  given.buckets = make_buckets(given.graph, given.exponent);
  return given;
}

struct Done {
  std::uint64_t records = 0, spilled_bytes = 0;
  std::size_t steps = 0;
};

Done run(const Given& given, const std::string& path) {
  MemoryBudget budget;
  ReebGraph graph = given.graph;
  ooc::RecordLog records(temp(), budget);
  const Hierarchy hierarchy = build_hierarchy(graph, pack_lists(given.buckets.view()), given.exponent, records);
  ooc::HierarchyInMemory in_memory(graph, hierarchy);
  ooc::write_hierarchy_file(path, given.meta(), {in_memory, records, !given.buckets.offsets.empty(), true});
  return {records.record_count(), records.spilled_bytes(), hierarchy.persistence.size()};
}

void BM_SecondStage(benchmark::State& state) {
  const Given given = make(state);
  const std::string path = temp().folder() + "/second_stage_bench.reeb";
  Done done;
  const std::size_t peak = test::peak_of([&] { done = run(given, path); });
  const ooc::ReebFile file(path);
  file.verify();
  if (file.load(0).graph != given.graph) return state.SkipWithError("wrong finest level");
  for (auto _ : state) run(given, path);

  const auto arcs = static_cast<double>(given.graph.arc_count());
  state.counters["arcs"] = arcs;
  state.counters["time_per_arc"] =
      benchmark::Counter(arcs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["peak_bytes_per_arc"] = static_cast<double>(peak) / arcs;
  state.counters["buckets_per_arc"] = static_cast<double>(given.buckets.buckets.size()) / arcs;
  state.counters["updates_per_step"] = (static_cast<double>(done.records) - arcs) / static_cast<double>(done.steps);
  state.counters["log_bytes_per_arc"] = static_cast<double>(done.spilled_bytes) / arcs;
  state.counters["file_bytes_per_arc"] = static_cast<double>(std::filesystem::file_size(path)) / arcs;
  std::filesystem::remove(path);
}

void sizes_and_kinds(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"kind", "arcs", "buckets"})->Unit(benchmark::kMillisecond);
  for (const std::int64_t kind : {std::int64_t{kPlate}, std::int64_t{kNoise}, std::int64_t{kExpander}, kRandomFunction})
    for (const std::int64_t buckets : {0, 64}) {
      bench->Args({kind, 10'000, buckets})->Args({kind, 1'000'000, buckets});
      if (std::getenv("REEB_BENCH_LARGE") != nullptr) bench->Args({kind, 10'000'000, buckets});
    }
}
BENCHMARK(BM_SecondStage)->Apply(sizes_and_kinds);

}  // namespace

BENCHMARK_MAIN();
