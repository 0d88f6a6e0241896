// The cost of the out-of-core structures per item: table hits, the last-use pass, segments.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/byte_coding.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/chunks/last_use.h"
#include "ooc/sorting/column_codec.h"
#include "ooc/stored_graph/segment_store.h"
#include "ooc/tables/paged_table.h"
#include "ooc/whole_mesh/reorder.h"

namespace {

using namespace reeb;
using namespace reeb::ooc;

const io::TempDir& temp() {
  static const io::TempDir dir(io::TempDir::default_folder("/tmp/."));
  return dir;
}

// A grid of the given width, row by row, generated while it is read.
class GridMesh : public IndexedMesh {
 public:
  GridMesh(std::uint64_t width, std::uint64_t height) : width_(width), height_(height) {}
  std::uint64_t vertex_count() const override { return width_ * height_; }
  unsigned column_count() const override { return 3; }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const std::uint64_t x = ids[i].value() % width_, y = ids[i].value() / width_;
        values[k * ids.size() + i] = static_cast<double>(columns[k] == 0 ? x : columns[k] == 1 ? y : (x * y) % 17);
      }
  }
  SimplexCounts simplex_counts() const override { return {0, 0, triangle_count()}; }
  void rewind() override { x_ = y_ = 0; }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    corners.clear();
    while (corners.size() + 6 <= std::max<std::size_t>(6, 3 * limit) && y_ + 1 < height_) {
      const std::uint64_t v = y_ * width_ + x_;
      for (const std::uint64_t c : {v, v + 1, v + width_, v + 1, v + width_ + 1, v + width_}) corners.emplace_back(c);
      if (++x_ + 1 == width_) x_ = 0, ++y_;
    }
    return !corners.empty();
  }
  std::uint64_t bytes_read() const override { return 0; }
  std::uint64_t bytes_total() const override { return 0; }
  std::uint64_t triangle_count() const { return 2 * (width_ - 1) * (height_ - 1); }

 private:
  std::uint64_t width_, height_, x_ = 0, y_ = 0;
};

// Indices as a mesh names them: a slow drift with jumps of one row.
std::vector<std::uint64_t> drifting_places(std::size_t count, std::uint64_t row) {
  std::vector<std::uint64_t> places(count);
  for (std::size_t i = 0; i < count; ++i) places[i] = i / 6 + (i % 2) * row;
  return places;
}

void BM_PagedTableHit(benchmark::State& state) {
  const auto places = drifting_places(1 << 20, 3000);
  const auto allowance = static_cast<std::uint64_t>(state.range(0)) << 20;
  const bool writing = state.range(1) != 0;
  MemoryBudget budget;
  PagedTable<std::uint32_t> table("table", temp(), budget, allowance, 0u);
  std::uint64_t sum = 0, expected = 0;
  for (std::size_t i = 0; i < places.size(); ++i) table.set(places[i], static_cast<std::uint32_t>(places[i]));
  for (const auto place : places) sum += table.get(place), expected += place;
  if (sum != expected) return state.SkipWithError("wrong entries");
  for (auto _ : state)
    for (const auto place : places) {
      if (writing)
        table.set(place, 7);
      else
        sum += table.get(place);
    }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
  state.counters["spilled"] = static_cast<double>(table.pages().spilled_bytes());
}
BENCHMARK(BM_PagedTableHit)->ArgsProduct({{0, 16}, {0, 1}})->ArgNames({"allowance_MiB", "set"});

void BM_LastUse(benchmark::State& state) {
  GridMesh mesh(2000, 1000);
  MemoryBudget budget;
  LastUseOptions options;
  options.allowance_bytes = static_cast<std::uint64_t>(state.range(0)) << 20;
  const bool scan = state.range(1) != 0;
  if (scan_last_use(mesh, temp(), budget, options)->summary().triangle_count != mesh.triangle_count())
    return state.SkipWithError("wrong count");
  std::vector<VertexId> corners;
  for (auto _ : state) {
    if (scan) {
      benchmark::DoNotOptimize(scan_last_use(mesh, temp(), budget, options)->summary());
    } else {
      mesh.rewind();
      while (mesh.read(corners, 4096)) benchmark::DoNotOptimize(corners.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangle_count()));
}
BENCHMARK(BM_LastUse)
    ->Args({1, 0})  // reading alone
    ->Args({1, 1})
    ->Args({16, 1})
    ->ArgNames({"allowance_MiB", "scan"})
    ->Unit(benchmark::kMillisecond);

// Arcs like those of a noisy surface: short, in the order of a sweep that wanders.
std::vector<ArcKeys> noisy_arcs(std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<ArcKeys> arcs(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double lo = static_cast<float>(static_cast<double>(random() % 1'000'000) * 1e-3);
    const double hi = static_cast<float>(lo + 1e-3 * static_cast<double>(1 + random() % 50));
    arcs[i] = {{lo, VertexId(i * 20)}, {hi, VertexId(i * 20 + 1 + random() % 4000)}};
  }
  return arcs;
}

void BM_SegmentLevel(benchmark::State& state) {
  auto arcs = noisy_arcs(1 << 16);
  std::sort(arcs.begin(), arcs.end());
  arcs.resize(2048);
  ColumnEncoder columns;
  columns.add(arcs.size(), [&](std::size_t i) {
    return ordered_bits(arcs[i].lo.value) - (i == 0 ? 0 : ordered_bits(arcs[i - 1].lo.value));
  });
  columns.add(arcs.size(), [&](std::size_t i) {
    return zigzag(arcs[i].lo.vertex.value() - (i == 0 ? 0 : arcs[i - 1].lo.vertex.value()));
  });
  columns.add(arcs.size(),
              [&](std::size_t i) { return ordered_bits(arcs[i].hi.value) - ordered_bits(arcs[i].lo.value); });
  columns.add(arcs.size(),
              [&](std::size_t i) { return zigzag(arcs[i].hi.vertex.value() - arcs[i].lo.vertex.value()); });
  std::vector<std::byte> packed;
  for (auto _ : state) {
    packed.clear();
    columns.pack(packed, static_cast<int>(state.range(0)));
  }
  if (!ColumnDecoder(packed, 4, arcs.size()).ok()) return state.SkipWithError("wrong bytes");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(arcs.size()));
  state.counters["bytes_an_arc"] = static_cast<double>(packed.size()) / static_cast<double>(arcs.size());
}
BENCHMARK(BM_SegmentLevel)->Arg(-3)->Arg(-1)->Arg(1)->Arg(3)->Arg(6)->ArgName("level");

void BM_Segments(benchmark::State& state) {
  const auto arcs = noisy_arcs(2'000'000);
  const bool merging = state.range(0) != 0;
  for (auto _ : state) {
    MemoryBudget budget;
    SegmentStore store(temp(), budget, {.allowance_bytes = 8 << 20, .background = true});
    if (merging) state.PauseTiming();
    store.add_arcs({arcs});
    store.finish();
    if (merging) {
      state.ResumeTiming();
      std::uint64_t count = 0;
      for (ArcPiece some; store.read_arcs(some, 4096);) count += some.arcs.size();
      if (count != arcs.size()) return state.SkipWithError("arcs were lost");
    }
    state.counters["bytes_an_arc"] = static_cast<double>(store.spilled_bytes()) / static_cast<double>(arcs.size());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(arcs.size()));
}
BENCHMARK(BM_Segments)->Arg(0)->Arg(1)->ArgName("merging")->Unit(benchmark::kMillisecond)->UseRealTime();

// A grid whose vertices are renumbered by a multiplicative permutation: every lookup is far away.
class ScatteredGrid : public GridMesh {
 public:
  ScatteredGrid(std::uint64_t width, std::uint64_t height) : GridMesh(width, height), prime_(1'000'000'007) {}
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    grid_ids_.clear();
    for (const VertexId v : ids) grid_ids_.emplace_back(v.value() * prime_ % vertex_count());
    GridMesh::gather(grid_ids_, columns, values);
  }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    if (!GridMesh::read(corners, limit)) return false;
    for (VertexId& v : corners) v = VertexId(v.value() * inverse() % vertex_count());
    return true;
  }

 private:
  std::uint64_t inverse() {
    if (inverse_ != 0) return inverse_;
    std::int64_t a = static_cast<std::int64_t>(prime_ % vertex_count()), b = static_cast<std::int64_t>(vertex_count());
    std::int64_t x = 1, y = 0;
    while (b != 0) {
      const std::int64_t q = a / b;
      a = std::exchange(b, a - q * b);
      x = std::exchange(y, x - q * y);
    }
    const auto n = static_cast<std::int64_t>(vertex_count());
    return inverse_ = static_cast<std::uint64_t>((x % n + n) % n);
  }
  std::uint64_t prime_, inverse_ = 0;
  std::vector<VertexId> grid_ids_;
};

void BM_Reorder(benchmark::State& state) {
  ScatteredGrid mesh(static_cast<std::uint64_t>(state.range(0)), static_cast<std::uint64_t>(state.range(0)));
  for (auto _ : state) {
    MemoryBudget budget(64 << 20);
    const auto reordered = reorder(mesh, temp(), budget, {.allowance_bytes = 48 << 20, .threads = 2});
    if (reordered->triangle_count() != mesh.triangle_count()) return state.SkipWithError("wrong count");
    state.counters["peak_MiB"] = static_cast<double>(budget.peak_bytes() >> 20);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangle_count()));
}
BENCHMARK(BM_Reorder)
    ->Arg(700)
    ->Arg(2450)
    ->ArgName("side")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
