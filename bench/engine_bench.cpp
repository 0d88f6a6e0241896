// The engine without input and output: sweeping chunks and gluing their fragments, one thread.
//
// Arguments: function (0 x, 1 y, 2 z, 3 random), layout (0 rows of 256 cells, 1 rows of 20,000, 2 patches, 3 flat grid
// in rows of 256: ties along the stream), triangles per chunk, extras (0 the graph only, 1 noise removal below 0.1 % of
// the range, 2 an embedding of 64 buckets, 3 both). Counters: processor time of sweep and glue in ns per triangle, the
// smallest of all iterations; steps per zip; largest scratch memory of the sweep and largest live structure in MB.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/generate/generator.h"
#include "libreeb/base/hash.h"
#include "libreeb/engine/glue.h"
#include "libreeb/sweep/chunk_sweep.h"

namespace {

using namespace reeb;

constexpr std::uint64_t kTriangles = 2'000'000;
constexpr std::int64_t kRandom = 3;
constexpr std::int64_t kNoiseRemoval = 1, kEmbedding = 2;  // extras
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
      mesh.coordinates[k].insert(mesh.coordinates[k].end(), batch.coordinates[k].begin(), batch.coordinates[k].end());
    for (const VertexId v : batch.triangles()) mesh.corners.push_back(v.value());
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
  return static_cast<double>(mix(mix(1) + v) >> 11) * 0x1p-53;
}

struct Input {
  Chunk chunk;
  std::vector<double> values;
  double least = 0, most = 0;  // value up to and with this chunk
};

// The range of these values and of all inputs except the last.
std::pair<double, double> range_with(const std::vector<Input>& inputs, std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (inputs.size() == 1) return {*least, *most};
  const Input& before = inputs[inputs.size() - 2];
  return {std::min(*least, before.least), std::max(*most, before.most)};
}

std::vector<Input> cut(const Mesh& mesh, std::int64_t function, std::size_t size) {
  constexpr std::uint32_t kNotYet = ~std::uint32_t{0};
  std::vector<Input> inputs;
  std::vector<std::uint32_t> local(mesh.first_use.size(), kNotYet);
  for (std::size_t begin = 0; 3 * begin < mesh.corners.size(); begin += size) {
    const std::size_t end = std::min(begin + size, mesh.corners.size() / 3);
    auto& [chunk, values, least, most] = inputs.emplace_back();
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
      const std::uint64_t v = mesh.corners[i];
      if (local[v] == kNotYet) {
        local[v] = static_cast<std::uint32_t>(chunk.vertex_count());
        chunk.ids.emplace_back(v);
        chunk.uses.push_back(static_cast<std::uint8_t>((mesh.first_use[v] < begin ? kUsedEarlier : 0) |
                                                       (mesh.last_use[v] >= end ? kUsedLater : 0)));
        values.push_back(value(mesh, function, v));
        chunk.positions.push_back({mesh.coordinates[0][v], mesh.coordinates[1][v], mesh.coordinates[2][v]});
      }
      chunk.corners.push_back(local[v]);
    }
    for (const VertexId v : chunk.ids) local[v.value()] = kNotYet;
    std::tie(least, most) = range_with(inputs, values);
  }
  return inputs;
}

struct CountingSink : GraphSink {
  void add_nodes(std::span<const SettledNode> more) override { nodes += more.size(); }
  void add_arcs(const SettledArcs& more) override {
    arcs += more.arcs.size();
    buckets.clear();
    for (std::size_t i = 0; i < more.lists.ends.size(); ++i) more.lists.unpack(i, buckets);
    for (const Bucket& bucket : buckets) vertices += bucket.count;
    for (const ArcKeys& arc : more.arcs) check ^= mix(arc.lo.vertex.value() ^ mix(arc.hi.vertex.value()));
  }
  std::uint64_t nodes = 0, arcs = 0, check = 0;
  std::uint64_t vertices = 0;  // in buckets
  std::vector<Bucket> buckets;
};

struct Result {
  std::uint64_t nodes = 0, arcs = 0, check = 0, vertices = 0, removed = 0;
  std::clock_t sweep = 0, glue = 0;
  std::size_t sweep_bytes = 0, live_bytes = 0;
};

SweepOptions options_of(const Input& input, std::int64_t extras) {
  SweepOptions options;
  if ((extras & kNoiseRemoval) != 0) options.noise_below = 0.001 * (input.most - input.least);
  if ((extras & kEmbedding) != 0) options.bucket_exponent = bucket_exponent(input.least, input.most, 64);
  return options;
}

Result run(const std::vector<Input>& inputs, std::int64_t extras = 0) {
  CountingSink sink;
  ChunkSweep sweep;
  Glue glue(sink, true);
  Fragment fragment;
  Result result;
  for (const Input& input : inputs) {
    const std::clock_t start = std::clock();
    sweep.run(input.chunk, input.values, fragment, options_of(input, extras));
    const std::clock_t swept = std::clock();
    glue.add(fragment);
    result.sweep += swept - start;
    result.glue += std::clock() - swept;
    result.live_bytes = std::max(result.live_bytes, glue.memory_bytes());
  }
  result.nodes = sink.nodes;
  result.vertices = sink.vertices;
  result.removed = glue.removed_pairs();
  result.arcs = sink.arcs;
  result.check = sink.check;
  result.sweep_bytes = sweep.memory_bytes();
  return result;
}

// Empty if the chunks give the same graph as the whole mesh in one chunk, and that graph has the components of the mesh
// and no more loops than it can have.
std::string fault(const Mesh& mesh, std::int64_t function, const Result& result) {
  const Result whole = run(cut(mesh, function, mesh.corners.size() / 3));
  if (result.nodes != whole.nodes || result.arcs != whole.arcs || result.check != whole.check)
    return "another graph than from one chunk";
  // A connected mesh has a connected graph.
  if (mesh.topology.components != 1) return "expects one component";
  const std::uint64_t loops = result.arcs + 1 - result.nodes;
  return loops <= mesh.topology.max_reeb_loops ? "" : "too many loops";
}

// Empty if the extras lose neither a loop nor a vertex.
std::string fault_of_extras(const Mesh& mesh, const Result& plain, const Result& extra, std::int64_t extras) {
  if (extra.arcs - extra.nodes != plain.arcs - plain.nodes) return "loops astray";
  if ((extras & kEmbedding) != 0 && extra.nodes + extra.vertices != mesh.first_use.size()) return "vertices astray";
  return "";
}

void BM_Engine(benchmark::State& state) {
  const Mesh& mesh = mesh_of(static_cast<Layout>(state.range(1)));
  const auto inputs = cut(mesh, state.range(0), static_cast<std::size_t>(state.range(2)));
  const std::int64_t extras = state.range(3);
  const Result plain = run(inputs);
  Result best = run(inputs, extras);
  std::string what = fault(mesh, state.range(0), plain);
  if (what.empty()) what = fault_of_extras(mesh, plain, best, extras);
  if (!what.empty()) return state.SkipWithError(what.c_str());
  for (auto _ : state) {
    const Result result = run(inputs, extras);
    best.sweep = std::min(best.sweep, result.sweep);
    best.glue = std::min(best.glue, result.glue);
  }
  const double triangles = static_cast<double>(mesh.corners.size()) / 3;
  const double ns = 1e9 / CLOCKS_PER_SEC / triangles;
  state.counters["sweep_ns"] = static_cast<double>(best.sweep) * ns;
  state.counters["glue_ns"] = static_cast<double>(best.glue) * ns;
  state.counters["sweep_MB"] = static_cast<double>(best.sweep_bytes) / 1e6;
  state.counters["removed"] = static_cast<double>(best.removed);
  state.counters["live_MB"] = static_cast<double>(best.live_bytes) / 1e6;
}
BENCHMARK(BM_Engine)
    ->ArgNames({"function", "layout", "chunk", "extras"})
    ->ArgsProduct({{0, 1, 2, kRandom}, {kNarrowRows}, {32'768}, {0}})
    ->Args({2, kNarrowRows, 65'536, 0})
    ->Args({kRandom, kNarrowRows, 65'536, 0})
    ->ArgsProduct({{1, 2}, {kFlatGrid}, {32'768}, {0}})
    ->ArgsProduct({{2, kRandom}, {kPatches}, {32'768}, {0}})
    ->ArgsProduct({{2, kRandom}, {kPatches}, {65'536}, {0, 1, 2, 3}})
    ->ArgsProduct({{1, 2, kRandom}, {kWideRows}, {65'536, 262'144}, {0}})
    ->ArgsProduct({{2}, {kWideRows}, {65'536, 262'144}, {kNoiseRemoval, kEmbedding, 3}})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
