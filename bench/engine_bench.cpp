// The engine without input and output: sweeping chunks and gluing their fragments, one thread.
//
// Arguments: function (0 x, 1 y, 2 z, 3 random), layout (0 rows of 256 cells, 1 rows of 20,000,
// 2 patches, 3 flat grid in rows of 256: ties along the stream), triangles a chunk.
// Counters: processor time of sweep and glue in ns a triangle, the least of all iterations; steps
// a zip; largest scratch memory of the sweep and largest live structure in MB.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "io/generator/generator.h"
#include "io/generator/noise.h"
#include "libreeb/engine/chunk_sweep.h"
#include "libreeb/engine/glue.h"

namespace {

using namespace reeb;

constexpr std::uint64_t kTriangles = 2'000'000;
constexpr std::int64_t kRandom = 3;
enum Layout : std::int64_t { kNarrowRows, kWideRows, kPatches, kFlatGrid };

struct Mesh {
  io::ExpectedTopology topology;
  std::vector<std::vector<double>> coordinates;
  std::vector<std::uint64_t> corners;
  std::vector<std::size_t> first_use, last_use;  // triangles, by vertex
};

Mesh read_mesh(Layout layout) {
  io::GeneratorOptions options;
  options.kind = layout == kFlatGrid ? io::MeshKind::kGrid : io::MeshKind::kScan;
  options.order = layout == kPatches ? io::MeshOrder::kPatches : io::MeshOrder::kRows;
  options.triangles = kTriangles;
  if (layout != kPatches) options.width = layout == kWideRows ? 20'000 : 256;
  const auto reader = io::generate_mesh(options);
  Mesh mesh{reader->topology(), std::vector<std::vector<double>>(3), {}, {}, {}};
  for (MeshBatch batch; reader->read(batch);) {
    for (std::size_t k = 0; k < 3; ++k)
      mesh.coordinates[k].insert(mesh.coordinates[k].end(), batch.coordinates[k].begin(),
                                 batch.coordinates[k].end());
    for (const VertexId v : batch.triangles) mesh.corners.push_back(v.value());
  }
  const std::size_t vertices = mesh.coordinates[0].size();
  mesh.first_use.assign(vertices, std::numeric_limits<std::size_t>::max());
  mesh.last_use.assign(vertices, 0);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    auto& first = mesh.first_use[mesh.corners[i]];
    first = std::min(first, i / 3);
    mesh.last_use[mesh.corners[i]] = i / 3;
  }
  return mesh;
}

const Mesh& mesh_of(Layout layout) {
  static std::map<Layout, Mesh> meshes;
  if (!meshes.contains(layout)) {
    meshes.clear();  // one at a time
    meshes.emplace(layout, read_mesh(layout));
  }
  return meshes.at(layout);
}

double value(const Mesh& mesh, std::int64_t function, std::uint64_t v) {
  if (function != kRandom) return mesh.coordinates[static_cast<std::size_t>(function)][v];
  return static_cast<double>(io::mix(io::mix(1) + v) >> 11) * 0x1p-53;
}

struct Input {
  Chunk chunk;
  std::vector<double> values;
};

std::vector<Input> cut(const Mesh& mesh, std::int64_t function, std::size_t size) {
  constexpr std::uint32_t kNotYet = ~std::uint32_t{0};
  std::vector<Input> inputs;
  std::vector<std::uint32_t> local(mesh.first_use.size(), kNotYet);
  for (std::size_t begin = 0; 3 * begin < mesh.corners.size(); begin += size) {
    const std::size_t end = std::min(begin + size, mesh.corners.size() / 3);
    auto& [chunk, values] = inputs.emplace_back();
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
      const std::uint64_t v = mesh.corners[i];
      if (local[v] == kNotYet) {
        local[v] = static_cast<std::uint32_t>(chunk.vertex_count());
        chunk.ids.emplace_back(v);
        chunk.uses.push_back(
            static_cast<std::uint8_t>((mesh.first_use[v] < begin ? kUsedEarlier : 0) |
                                      (mesh.last_use[v] >= end ? kUsedLater : 0)));
        values.push_back(value(mesh, function, v));
      }
      chunk.corners.push_back(local[v]);
    }
    for (const VertexId v : chunk.ids) local[v.value()] = kNotYet;
  }
  return inputs;
}

struct CountingSink : GraphSink {
  void add_nodes(std::span<const SettledNode> more) override { nodes += more.size(); }
  void add_arcs(const SettledArcs& more) override {
    arcs += more.arcs.size();
    for (const ArcKeys& arc : more.arcs) check ^= io::mix(arc.lo.vertex.value() ^ io::mix(arc.hi.vertex.value()));
  }
  std::uint64_t nodes = 0, arcs = 0, check = 0;
};

struct Result {
  std::uint64_t nodes = 0, arcs = 0, check = 0;
  std::uint64_t zips = 0, zip_steps = 0;
  std::clock_t sweep = 0, glue = 0;
  std::size_t sweep_bytes = 0, live_bytes = 0;
};

Result run(const std::vector<Input>& inputs) {
  CountingSink sink;
  ChunkSweep sweep;
  Glue glue(sink, false);
  Fragment fragment;
  Result result;
  for (const auto& [chunk, values] : inputs) {
    const std::clock_t start = std::clock();
    sweep.run(chunk, values, fragment);
    const std::clock_t swept = std::clock();
    glue.add(fragment);
    result.sweep += swept - start;
    result.glue += std::clock() - swept;
    result.live_bytes = std::max(result.live_bytes, glue.memory_bytes());
  }
  glue.complete_all();
  result.nodes = sink.nodes;
  result.arcs = sink.arcs;
  result.check = sink.check;
  result.zips = glue.graph().zips();
  result.zip_steps = glue.graph().zip_steps();
  result.sweep_bytes = sweep.memory_bytes();
  return result;
}

// Empty if the chunks gave the graph that the mesh in one piece gives, and that has the
// components of the mesh and no more loops than it can have.
std::string fault(const Mesh& mesh, std::int64_t function, const Result& result) {
  const Result whole = run(cut(mesh, function, mesh.corners.size() / 3));
  if (result.nodes != whole.nodes || result.arcs != whole.arcs || result.check != whole.check)
    return "another graph than from one chunk";
  // A connected mesh has a connected graph.
  if (mesh.topology.components != 1) return "expects one component";
  const std::uint64_t loops = result.arcs + 1 - result.nodes;
  return loops <= mesh.topology.max_reeb_loops ? "" : "too many loops";
}

void BM_Engine(benchmark::State& state) {
  const Mesh& mesh = mesh_of(static_cast<Layout>(state.range(1)));
  const auto inputs = cut(mesh, state.range(0), static_cast<std::size_t>(state.range(2)));
  Result best = run(inputs);
  if (const std::string what = fault(mesh, state.range(0), best); !what.empty())
    return state.SkipWithError(what.c_str());
  for (auto _ : state) {
    const Result result = run(inputs);
    best.sweep = std::min(best.sweep, result.sweep);
    best.glue = std::min(best.glue, result.glue);
  }
  const double triangles = static_cast<double>(mesh.corners.size()) / 3;
  const double ns = 1e9 / CLOCKS_PER_SEC / triangles;
  state.counters["sweep_ns"] = static_cast<double>(best.sweep) * ns;
  state.counters["glue_ns"] = static_cast<double>(best.glue) * ns;
  state.counters["steps_a_zip"] =
      static_cast<double>(best.zip_steps) / static_cast<double>(std::max<std::uint64_t>(best.zips, 1));
  state.counters["zips_1000"] = 1000 * static_cast<double>(best.zips) / triangles;
  state.counters["sweep_MB"] = static_cast<double>(best.sweep_bytes) / 1e6;
  state.counters["live_MB"] = static_cast<double>(best.live_bytes) / 1e6;
}
BENCHMARK(BM_Engine)
    ->ArgNames({"function", "layout", "chunk"})
    ->ArgsProduct({{0, 1, 2, kRandom}, {kNarrowRows}, {32'768}})
    ->Args({2, kNarrowRows, 65'536})
    ->Args({kRandom, kNarrowRows, 65'536})
    ->ArgsProduct({{1, 2}, {kFlatGrid}, {32'768}})
    ->ArgsProduct({{2, kRandom}, {kPatches}, {32'768, 65'536}})
    ->ArgsProduct({{1, 2, kRandom}, {kWideRows}, {65'536, 262'144}})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
