// How fast meshes are read: text in bytes per second, binary PLY in place in triangles and values.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/formats/open_mesh.h"

namespace {

namespace fs = std::filesystem;
using reeb::VertexId;

constexpr std::uint64_t kSide = 600;
constexpr std::uint64_t kVertices = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1);

enum class Kind { kAsciiPly, kObj, kBinaryPly };

void append(std::string& out, const auto& value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

// A grid of kSide x kSide vertices in row order, with eight digits per coordinate.
std::string grid(Kind kind) {
  std::string out;
  if (kind != Kind::kObj)
    out = std::string("ply\nformat ") + (kind == Kind::kAsciiPly ? "ascii" : "binary_little_endian") +
          " 1.0\nelement vertex " + std::to_string(kVertices) +
          "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(kTriangles) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::uint64_t i = 0; i < kVertices; ++i) {
    const double x = 0.00173 * static_cast<double>(i % kSide), y = 0.00173 * static_cast<double>(i / kSide);
    char line[128];
    const int size =
        std::snprintf(line, sizeof line, "%s%.7f %.7f %.7f\n", kind == Kind::kObj ? "v " : "", x, y, x * y);
    if (kind != Kind::kBinaryPly)
      out.append(line, static_cast<std::size_t>(size));
    else
      for (const double value : {x, y, x * y}) append(out, static_cast<float>(value));
  }
  for (std::uint64_t row = 0; row + 1 < kSide; ++row)
    for (std::uint64_t column = 0; column + 1 < kSide; ++column) {
      const std::uint64_t a = row * kSide + column, b = a + 1, c = a + kSide, d = c + 1;
      for (const auto& corners : {std::vector{a, b, c}, std::vector{b, d, c}}) {
        if (kind == Kind::kBinaryPly)
          out += '\3';
        else
          out += kind == Kind::kObj ? "f" : "3";
        for (const std::uint64_t corner : corners) {
          if (kind == Kind::kBinaryPly)
            append(out, static_cast<std::int32_t>(corner));
          else
            out.append(" ").append(std::to_string(corner + (kind == Kind::kObj ? 1 : 0)));
        }
        if (kind != Kind::kBinaryPly) out += "\n";
      }
    }
  return out;
}

class GridFile {
 public:
  explicit GridFile(Kind kind)
      : path_((fs::temp_directory_path() / ("reeb_reader_bench_" + std::to_string(::getpid()))).string()) {
    const std::string bytes = grid(kind);
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~GridFile() { fs::remove(path_); }
  GridFile(const GridFile&) = delete;
  GridFile& operator=(const GridFile&) = delete;

  const std::string& path() const { return path_; }
  std::int64_t bytes() const { return static_cast<std::int64_t>(fs::file_size(path_)); }

 private:
  std::string path_;
};

void BM_Stream(benchmark::State& state) {
  const GridFile file(static_cast<Kind>(state.range(0)));
  reeb::MeshBatch batch;
  for (auto _ : state) {
    std::uint64_t vertices = 0, triangles = 0;
    for (const auto reader = reeb::io::open_mesh(file.path()); reader->read(batch);) {
      vertices += batch.vertex_count;
      triangles += batch.triangle_count();
    }
    if (vertices != kVertices || triangles != kTriangles) return state.SkipWithError("wrong counts");
  }
  state.SetBytesProcessed(state.iterations() * file.bytes());
}
BENCHMARK(BM_Stream)
    ->Arg(static_cast<int>(Kind::kAsciiPly))
    ->Arg(static_cast<int>(Kind::kObj))
    ->Arg(static_cast<int>(Kind::kBinaryPly))
    ->ArgName("ascii_obj_binary")
    ->MeasureProcessCPUTime()  // some readers decode in a thread of their own
    ->Unit(benchmark::kMillisecond);

void BM_IndexedFaces(benchmark::State& state) {
  const GridFile file(Kind::kBinaryPly);
  const auto mesh = reeb::io::open_mesh(file.path())->indexed();
  std::vector<VertexId> corners;
  for (auto _ : state) {
    std::uint64_t triangles = 0;
    mesh->rewind();
    while (mesh->read(corners, 16384)) triangles += corners.size() / 3;
    if (triangles != kTriangles) return state.SkipWithError("wrong counts");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kTriangles));
}
BENCHMARK(BM_IndexedFaces)->Unit(benchmark::kMillisecond);

void BM_IndexedGather(benchmark::State& state) {
  const GridFile file(Kind::kBinaryPly);
  const auto mesh = reeb::io::open_mesh(file.path())->indexed();
  std::vector<VertexId> ids(16384);
  const std::vector<unsigned> columns = {2};
  std::vector<double> values(ids.size());
  for (auto _ : state)
    for (std::uint64_t begin = 0; begin + ids.size() <= kVertices; begin += ids.size()) {
      for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = VertexId(begin + (i * 37) % ids.size());
      mesh->gather(ids, columns, values);
      benchmark::DoNotOptimize(values.data());
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVertices / ids.size() * ids.size()));
}
BENCHMARK(BM_IndexedGather)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
