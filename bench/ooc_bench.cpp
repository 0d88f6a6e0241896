// What the out-of-core pieces cost by item: table hits, the last-use pass, segments.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "ooc/last_use.h"
#include "ooc/paged_table.h"
#include "ooc/temp_dir.h"

namespace {

using namespace reeb;
using namespace reeb::ooc;

const TempDir& temp() {
  static const TempDir dir(TempDir::default_folder("/tmp/."));
  return dir;
}

// A grid of the given width, row by row, made as it is read.
class GridMesh : public IndexedMesh {
 public:
  GridMesh(std::uint64_t width, std::uint64_t height) : width_(width), height_(height) {}
  std::uint64_t vertex_count() const override { return width_ * height_; }
  unsigned column_count() const override { return 3; }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns,
              std::span<double> values) override {
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const std::uint64_t x = ids[i].value() % width_, y = ids[i].value() / width_;
        values[k * ids.size() + i] =
            static_cast<double>(columns[k] == 0 ? x : columns[k] == 1 ? y : (x * y) % 17);
      }
  }
  void rewind() override { x_ = y_ = 0; }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    corners.clear();
    while (corners.size() + 6 <= std::max<std::size_t>(6, 3 * limit) && y_ + 1 < height_) {
      const std::uint64_t v = y_ * width_ + x_;
      for (const std::uint64_t c : {v, v + 1, v + width_, v + 1, v + width_ + 1, v + width_})
        corners.emplace_back(c);
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

// Places as a mesh names them: a slow drift with jumps of one row.
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

}  // namespace

BENCHMARK_MAIN();
