// How fast zstd packs and unpacks byte planes of arcs, by level. The segment level was chosen by it.
#include <benchmark/benchmark.h>

#include <random>

#include "io/file/zstd_codec.h"

namespace {

// Columns as a segment holds them: small deltas of ids as little-endian 64-bit numbers, by plane.
std::vector<std::byte> byte_planes(std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<std::byte> planes(count * 8);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t delta = random() % 5000;
    for (std::size_t b = 0; b < 8; ++b) planes[b * count + i] = static_cast<std::byte>(delta >> (8 * b));
  }
  return planes;
}

void BM_Zstd(benchmark::State& state) {
  const auto planes = byte_planes(65536);
  std::vector<std::byte> packed, back(planes.size());
  reeb::io::zstd_compress(planes, static_cast<int>(state.range(0)), packed);
  if (!reeb::io::zstd_decompress(packed, back) || back != planes) return state.SkipWithError("wrong bytes");
  for (auto _ : state) {
    packed.clear();
    reeb::io::zstd_compress(planes, static_cast<int>(state.range(0)), packed);
    benchmark::DoNotOptimize(packed.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(planes.size()));
  state.counters["ratio"] = static_cast<double>(planes.size()) / static_cast<double>(packed.size());
}
BENCHMARK(BM_Zstd)->Arg(-1)->Arg(1)->Arg(3)->Arg(6)->ArgName("level");

}  // namespace

BENCHMARK_MAIN();
