// Loading a level of a `.reeb` file: time and memory by the size of the level, from 100 nodes to a million.
//
// Arguments: embedding (0 or 1), nodes. The file is written once, for a noisy graph of 2.5 million arcs.
// docs/figures/loading.py draws the figure from the output.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "libreeb/hierarchy/levels.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/support/held_memory.h"
#include "tests/support/inputs/made_graph.h"

namespace {

using namespace reeb;
using namespace reeb::bench;

// A file, and the graph and hierarchy that it was written from.
class Sample {
 public:
  explicit Sample(bool embedding) : graph_(GraphMaker(kNoise, 2'500'000).make()) {
    for (const SweepKey& node : graph_.nodes)
      graph_.positions.push_back({static_cast<double>(node.vertex.value() % 1000), 0, node.value});
    const int exponent = bucket_exponent(graph_.nodes.front().value, graph_.nodes.back().value, 64);
    ArcBuckets buckets;
    if (embedding) buckets = make_buckets(graph_, exponent);
    ooc::FileMeta meta;
    meta.mesh_vertices = graph_.node_count() + buckets.buckets.size();
    meta.bucket_exponent = exponent;
    hierarchy_ = build_hierarchy(graph_, buckets, exponent);
    path_ = (std::filesystem::temp_directory_path() /
             ("loading-" + std::to_string(::getpid()) + (embedding ? "-e.reeb" : ".reeb")))
                .string();
    ooc::write_hierarchy_file(path_, meta, graph_, hierarchy_, buckets.view());
  }
  ~Sample() { std::filesystem::remove(path_); }
  Sample(const Sample&) = delete;

  const std::string& path() const { return path_; }
  bool is_right(const ooc::Level& level) const { return level.graph == graph_at(hierarchy_, graph_, level.version); }

 private:
  ReebGraph graph_;
  Hierarchy hierarchy_;
  std::string path_;
};

const Sample& sample(bool embedding) {
  static std::map<bool, Sample> samples;
  return samples.try_emplace(embedding, embedding).first->second;
}

ooc::Level load(const std::string& path, std::uint64_t nodes) {
  const ooc::ReebFile file(path);
  return file.load(file.finest_with_nodes(nodes));
}

void BM_Load(benchmark::State& state) {
  const Sample& made = sample(state.range(0) != 0);
  const auto nodes = static_cast<std::uint64_t>(state.range(1));
  ooc::Level level;
  const std::size_t before = test::held_bytes;
  const std::size_t peak = test::peak_of([&] { level = load(made.path(), nodes); });
  const std::size_t held = test::held_bytes - before;
  if (!made.is_right(level)) return state.SkipWithError("a wrong level");
  for (auto _ : state) benchmark::DoNotOptimize(load(made.path(), nodes));
  state.counters["nodes"] = static_cast<double>(level.graph.node_count());
  state.counters["promised_bytes"] = static_cast<double>(
      level_memory(level.graph.node_count(), level.graph.arc_count(), level.buckets.buckets.size()));
  state.counters["held_bytes"] = static_cast<double>(held);
  state.counters["peak_bytes"] = static_cast<double>(peak);
}
BENCHMARK(BM_Load)
    ->ArgNames({"embedding", "nodes"})
    ->ArgsProduct({{0, 1}, {100, 300, 1000, 3000, 10'000, 30'000, 100'000, 300'000, 1'000'000}})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
