// Pairing, hierarchy and noise removal: time and peak bytes an arc, by kind and size of graph.
//
// The graphs are made by a sweep over a row of contours in which neighbours merge and contours
// split, start and end. Arguments: kind (0 perforated plate: one row of strips, every hole a loop;
// 1 noise: starts and ends, most of them soon; 2 expander: any two contours of the row merge),
// arcs. Ten million arcs are left out unless REEB_BENCH_LARGE is set in the environment.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/denoise.h"
#include "libreeb/hierarchy/levels.h"
#include "libreeb/hierarchy/pairing.h"

namespace {

// What the process holds through operator new, as the allocator rounds it.
std::atomic<std::size_t> held_bytes{0}, peak_bytes{0};

}  // namespace

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t held = held_bytes += malloc_usable_size(memory);
  if (held > peak_bytes) peak_bytes = held;
  return memory;
}
void operator delete(void* memory) noexcept {
  if (memory != nullptr) held_bytes -= malloc_usable_size(memory);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace {

using namespace reeb;

enum Kind { kPlate, kNoise, kExpander };

class GraphMaker {
 public:
  GraphMaker(Kind kind, std::size_t arcs) : kind_(kind), arcs_wanted_(arcs) {}

  ReebGraph make() {
    start(0);
    while (arcs_.size() + row_.size() < arcs_wanted_) event();
    while (!row_.empty()) end(row_.size() - 1);
    return make_graph(std::move(arcs_), {});
  }

 private:
  static constexpr std::size_t kWidth = 1000;

  SweepKey next_key() {
    value_ += static_cast<double>(random_() % 1000) / 1000;
    return {value_, VertexId(vertex_++)};
  }
  std::size_t any() { return random_() % row_.size(); }
  auto place(std::size_t i) { return row_.begin() + static_cast<std::ptrdiff_t>(i); }

  void start(std::size_t i) { row_.insert(place(i), next_key()); }
  void end(std::size_t i) {
    arcs_.push_back({row_[i], next_key()});
    row_.erase(place(i));
  }
  void split(std::size_t i) {
    arcs_.push_back({row_[i], next_key()});
    row_[i] = arcs_.back().hi;
    row_.insert(place(i), row_[i]);
  }
  void merge(std::size_t i, std::size_t j) {
    const SweepKey key = next_key();
    arcs_.push_back({row_[i], key});
    arcs_.push_back({row_[j], key});
    row_[i] = key;
    row_.erase(place(j));
  }

  void event() {
    const bool grow = random_() % (2 * kWidth) >= row_.size();
    const std::size_t i = any();
    if (kind_ == kNoise && random_() % 2 == 0) {
      if (grow)
        start(i);
      else if (row_.size() > 1)
        end(i);
    } else if (grow || row_.size() == 1) {
      split(i);
      // A split that is followed at once by an end or a merge: small features are the most
      // frequent.
      if (kind_ == kNoise && random_() % 4 != 0) {
        if (random_() % 2 == 0)
          end(i);
        else
          merge(i, i + 1);
      }
    } else {
      const std::size_t j = kind_ == kExpander ? any() : (i + 1) % row_.size();
      if (i != j) merge(i, j);
    }
  }

  const Kind kind_;
  const std::size_t arcs_wanted_;
  std::mt19937_64 random_{1};
  double value_ = 0;
  std::uint64_t vertex_ = 0;
  std::vector<SweepKey> row_;  // the node below each contour
  std::vector<ArcKeys> arcs_;
};

ReebGraph make(const benchmark::State& state) {
  return GraphMaker(static_cast<Kind>(state.range(0)), static_cast<std::size_t>(state.range(1)))
      .make();
}

void report(benchmark::State& state, const ReebGraph& graph, std::size_t bytes) {
  const auto arcs = static_cast<double>(graph.arc_count());
  state.counters["arcs"] = arcs;
  state.counters["time_per_arc"] = benchmark::Counter(
      arcs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["peak_bytes_per_arc"] = static_cast<double>(bytes) / arcs;
}

// Runs `work` once, untimed. The most that was held while it ran, beyond what was held before.
template <class Work>
std::size_t peak_of(Work work) {
  const std::size_t before = held_bytes;
  peak_bytes = before;
  work();
  return peak_bytes - before;
}

std::size_t bytes_of(const ReebGraph& graph) {
  return graph.node_count() * sizeof(SweepKey) + graph.arc_count() * 2 * sizeof(NodeId);
}

void BM_Pairing(benchmark::State& state) {
  const ReebGraph graph = make(state);
  const BettiNumbers betti = betti_numbers(graph);
  std::vector<PersistencePair> pairs;
  const std::size_t peak = peak_of([&] { pairs = persistence_pairs(graph); });
  std::uint64_t components = 0, loops = 0;
  for (const auto& pair : pairs) {
    components += pair.type == PairType::kExt0;
    loops += pair.type == PairType::kExt1;
  }
  if (components != betti.components || loops != betti.loops)
    return state.SkipWithError("wrong pairs");
  for (auto _ : state) benchmark::DoNotOptimize(persistence_pairs(graph));
  report(state, graph, bytes_of(graph) + peak);
}

// The whole second stage, pairing included; the peak counts the graph it starts from.
void BM_Hierarchy(benchmark::State& state) {
  const ReebGraph graph = make(state);
  Hierarchy hierarchy;
  const std::size_t peak = peak_of([&] { hierarchy = build_hierarchy(graph); });
  if (graph_at(hierarchy, graph, 0) != graph) return state.SkipWithError("wrong finest level");
  const auto sizes = level_sizes(hierarchy);
  const ReebGraph coarsest = graph_at(hierarchy, graph, last_version(hierarchy));
  if (sizes.back().nodes != coarsest.node_count())
    return state.SkipWithError("wrong coarsest level");
  for (auto _ : state) benchmark::DoNotOptimize(build_hierarchy(graph));
  report(state, graph, peak);
  std::uint64_t kept = 0;
  for (const auto& pair : hierarchy.pairs) kept += pair.kept;
  state.counters["kept"] = static_cast<double>(kept);
  state.counters["records_per_step"] =
      static_cast<double>(hierarchy.arcs.size() - graph.arc_count()) /
      static_cast<double>(last_version(hierarchy));
}

void BM_Denoise(benchmark::State& state) {
  const ReebGraph graph = make(state);
  const double threshold = 20;
  Denoised result;
  const std::size_t peak = peak_of([&] { result = denoise(graph, threshold); });
  if (persistence_pairs(result.graph).size() + result.removed.size() !=
      persistence_pairs(graph).size())
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
