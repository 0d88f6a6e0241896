// How fast streaming meshes are decoded, in triangles per second of processor time, and how large they are, in bits per
// vertex.
#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "io/events/stream_writer.h"
#include "io/streaming/open_stream.h"
#include "io/streaming/stream_mesh_reader.h"
#include "tests/support/bytes_source.h"

namespace {

using namespace reeb::io;

// A rough height field of side x side vertices in rows. Each vertex is finalized with its last triangle.
std::string encode(std::uint32_t side, const std::function<std::unique_ptr<StreamWriter>(std::ostream&)>& make) {
  std::ostringstream out;
  const auto writer = make(out);
  StreamEvent event{};
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    event.kind = EventKind::kTriangle;
    event.corners = {a, b, c, 0};
    writer->write(event);
  };
  const auto finalize = [&](std::uint32_t v) {
    event.kind = EventKind::kFinalized;
    event.vertex = v;
    writer->write(event);
  };
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const auto x = static_cast<float>(column), y = static_cast<float>(row);
      event.kind = EventKind::kVertex;
      event.vertex = row * side + column;
      event.floats[0] = 0.1f * x;
      event.floats[1] = 0.1f * y;
      event.floats[2] = std::sin(0.07f * x) * std::cos(0.05f * y) + 0.001f * std::sin(13.7f * x * y);
      writer->write(event);
      if (row == 0 || column == 0) continue;
      const std::uint32_t v = row * side + column, below = v - side;
      triangle(below - 1, below, v);
      if (column == side - 1 && row + 1 <= side) finalize(below);
      triangle(below - 1, v, v - 1);
      finalize(below - 1);
      if (row != side - 1) continue;
      finalize(v - 1);
      if (column == side - 1) finalize(v);
    }
  }
  writer->close();
  return out.str();
}

std::unique_ptr<reeb::MeshReader> open_bytes(const std::string& bytes) {
  return make_stream_mesh_reader(open_stream(std::make_unique<reeb::test::BytesSource>(bytes)));
}

struct Counts {
  std::uint64_t vertices = 0, triangles = 0, finalized = 0;
};

Counts decode(const std::string& bytes) {
  Counts counts;
  const auto reader = open_bytes(bytes);
  reeb::MeshBatch batch;
  while (reader->read(batch)) {
    counts.vertices += batch.vertex_count;
    counts.triangles += batch.triangle_count();
    counts.finalized += batch.finalized.size();
  }
  return counts;
}

void run(benchmark::State& state, const std::function<std::unique_ptr<StreamWriter>(std::ostream&)>& make) {
  const auto side = static_cast<std::uint32_t>(state.range(0));
  const std::string bytes = encode(side, make);
  const std::uint64_t vertices = std::uint64_t{side} * side;
  const std::uint64_t triangles = 2 * std::uint64_t{side - 1} * (side - 1);
  const Counts counts = decode(bytes);
  if (counts.vertices != vertices || counts.triangles != triangles || counts.finalized != vertices)
    return state.SkipWithError("wrong counts");
  for (auto _ : state) benchmark::DoNotOptimize(decode(bytes));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(triangles));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
  state.counters["bits_per_vertex"] = 8 * static_cast<double>(bytes.size()) / static_cast<double>(vertices);
}

void BM_Sma(benchmark::State& state) {
  run(state, [](std::ostream& out) { return make_text_writer(out, {}); });
}
void BM_Smb(benchmark::State& state) {
  run(state, [](std::ostream& out) { return make_block_writer(out, {}); });
}
void BM_SmcLossless(benchmark::State& state) {
  run(state, [](std::ostream& out) { return make_smc_writer(out, {}); });
}
void BM_SmcQuantized16(benchmark::State& state) {
  const float extent = 0.1f * static_cast<float>(state.range(0));
  run(state, [extent](std::ostream& out) {
    StreamHeader header;
    header.box = StreamBox{{0, 0, -2}, {extent, extent, 2}};
    return make_smc_writer(out, header, {.version = 3, .precision = 16});
  });
}
BENCHMARK(BM_Sma)->Arg(1000)->ArgName("side");
BENCHMARK(BM_Smb)->Arg(1000)->ArgName("side");
BENCHMARK(BM_SmcLossless)->Arg(1000)->ArgName("side");
BENCHMARK(BM_SmcQuantized16)->Arg(1000)->ArgName("side");

}  // namespace

BENCHMARK_MAIN();
