// Pairing, hierarchy and noise removal in memory: time and peak bytes per arc, by kind and size of graph.
// second_stage_bench.cpp measures them with an embedding and records on disk.
//
// Arguments: kind (see made_graph.h), arcs. Ten million arcs are left out unless REEB_BENCH_LARGE is
// set in the environment.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "libreeb/hierarchy/levels.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/noise/denoise.h"
#include "tests/support/held_memory.h"
#include "tests/support/inputs/made_graph.h"

namespace {

using namespace reeb;
using namespace reeb::bench;

ReebGraph make(const benchmark::State& state) {
  return GraphMaker(static_cast<GraphKind>(state.range(0)), static_cast<std::size_t>(state.range(1))).make();
}

void report(benchmark::State& state, const ReebGraph& graph, std::size_t bytes) {
  const auto arcs = static_cast<double>(graph.arc_count());
  state.counters["arcs"] = arcs;
  state.counters["time_per_arc"] =
      benchmark::Counter(arcs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["peak_bytes_per_arc"] = static_cast<double>(bytes) / arcs;
}

std::size_t bytes_of(const ReebGraph& graph) {
  return graph.node_count() * sizeof(SweepKey) + graph.arc_count() * 2 * sizeof(NodeId);
}

void BM_Pairing(benchmark::State& state) {
  const ReebGraph graph = make(state);
  const BettiNumbers betti = betti_numbers(graph);
  std::vector<PersistencePair> pairs;
  const std::size_t peak = test::peak_of([&] { pairs = persistence_pairs(graph); });
  std::uint64_t components = 0, loops = 0;
  for (const auto& pair : pairs) {
    components += pair.type == PairType::kExt0;
    loops += pair.type == PairType::kExt1;
  }
  if (components != betti.components || loops != betti.loops) return state.SkipWithError("wrong pairs");
  for (auto _ : state) benchmark::DoNotOptimize(persistence_pairs(graph));
  report(state, graph, bytes_of(graph) + peak);
}

// Includes pairing. The peak counts the graph it starts from, and the records.
void BM_Hierarchy(benchmark::State& state) {
  const ReebGraph graph = make(state);
  Hierarchy hierarchy;
  const std::size_t peak = test::peak_of([&] { hierarchy = build_hierarchy(graph); });
  if (graph_at(hierarchy, graph, 0) != graph) return state.SkipWithError("wrong finest level");
  const auto sizes = level_sizes(hierarchy);
  const ReebGraph coarsest = graph_at(hierarchy, graph, last_version(hierarchy));
  if (sizes.back().nodes != coarsest.node_count()) return state.SkipWithError("wrong coarsest level");
  for (auto _ : state) benchmark::DoNotOptimize(build_hierarchy(graph));
  report(state, graph, peak);
  std::uint64_t kept = 0;
  for (const auto& pair : hierarchy.pairs) kept += pair.kept;
  state.counters["kept"] = static_cast<double>(kept);
  state.counters["records_per_step"] =
      static_cast<double>(hierarchy.arcs.size() - graph.arc_count()) / static_cast<double>(last_version(hierarchy));
}

void BM_Denoise(benchmark::State& state) {
  const ReebGraph graph = make(state);
  const double threshold = 20;
  Denoised result;
  const std::size_t peak = test::peak_of([&] { result = denoise(graph, threshold); });
  if (persistence_pairs(result.graph).size() + result.removed.size() != persistence_pairs(graph).size())
    return state.SkipWithError("wrong count of pairs");
  for (auto _ : state) benchmark::DoNotOptimize(denoise(graph, threshold));
  report(state, graph, bytes_of(graph) + peak);
  state.counters["removed"] = static_cast<double>(result.removed.size());
}

void sizes_and_kinds(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"kind", "arcs"})->Unit(benchmark::kMillisecond);
  for (const std::int64_t kind : {kPlate, kNoise, kExpander}) {
    bench->Args({kind, 10'000})->Args({kind, 1'000'000});
    if (std::getenv("REEB_BENCH_LARGE") != nullptr) bench->Args({kind, 10'000'000});
  }
}
BENCHMARK(BM_Pairing)->Apply(sizes_and_kinds);
BENCHMARK(BM_Hierarchy)->Apply(sizes_and_kinds);
BENCHMARK(BM_Denoise)->Apply(sizes_and_kinds);

}  // namespace

BENCHMARK_MAIN();
