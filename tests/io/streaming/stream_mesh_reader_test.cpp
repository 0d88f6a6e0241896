// The adapter to MeshReader: pre-order and post-order files both give legal streams.
#include "io/streaming/stream_mesh_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "io/events/pre_order.h"
#include "io/events/stream_writer.h"
#include "tests/io/streaming/samples.h"
#include "tests/support/same.h"

namespace reeb::io {
namespace {

using Cell = std::vector<std::uint64_t>;

// Checks a stream by the definition, with plain sets.
struct Checker {
  std::set<std::uint64_t> arrived, final;
  std::multiset<Cell> cells;
  std::map<std::uint64_t, std::array<double, 3>> positions;

  void cell(std::span<const VertexId> corners) {
    Cell cell;
    for (const VertexId v : corners) {
      EXPECT_TRUE(arrived.contains(v.value())) << "a cell before its vertex";
      EXPECT_FALSE(final.contains(v.value())) << "a cell after a finalization";
      cell.push_back(v.value());
    }
    cells.insert(cell);
  }

  void batch(const MeshBatch& batch) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      const std::uint64_t vertex = batch.first_vertex.value() + i;
      EXPECT_EQ(vertex, arrived.size()) << "numbers have a gap";
      arrived.insert(vertex);
      positions[vertex] = {batch.coordinates[0][i], batch.coordinates[1][i], batch.coordinates[2][i]};
    }
    batch.for_each_simplex([this](std::span<const VertexId> corners) { cell(corners); });
    for (const VertexId vertex : batch.finalized) {
      EXPECT_TRUE(arrived.contains(vertex.value())) << "finalized before it arrived";
      EXPECT_TRUE(final.insert(vertex.value()).second) << "finalized twice";
    }
  }
};

std::unique_ptr<MeshReader> open_mesh_bytes(const Sample& sample, const std::string& bytes, std::size_t batch_events) {
  ReadOptions options;
  options.batch_events = batch_events;
  options.signed_zeros = true;
  return make_stream_mesh_reader(open_bytes(bytes, sample.file), options, bytes.size());
}

// The cells of a golden listing.
std::multiset<Cell> golden_cells(const std::string& file) {
  std::istringstream lines(golden_events(file));
  std::multiset<Cell> cells;
  for (std::string line; std::getline(lines, line);) {
    if (line[0] != 't' && line[0] != 'c') continue;
    std::istringstream numbers(line.substr(1));
    Cell cell(line[0] == 't' ? 3 : 4);
    for (std::uint64_t& corner : cell) numbers >> corner;
    cells.insert(cell);
  }
  return cells;
}

std::string events_of(MeshReader& reader) {
  std::ostringstream text;
  OutputBuffer out(text);
  for (MeshBatch batch; reader.read(batch);) write_events(out, batch, batch.properties.size(), false);
  out.flush();
  return text.str();
}

TEST(StreamMeshReader, EverySampleIsALegalStreamWithAllItsCells) {
  for (const Sample& sample : all_samples()) {
    if (!sample.good()) continue;
    const std::string bytes = sample_bytes(sample.file);
    for (const std::size_t batch_events : {1u, 5u, 65536u}) {
      SCOPED_TRACE(sample.file + " by " + std::to_string(batch_events));
      const auto reader = open_mesh_bytes(sample, bytes, batch_events);
      Checker checker;
      MeshBatch batch;
      while (reader->read(batch)) {
        checker.batch(batch);
        if (batch_events == 1) {
          EXPECT_EQ(batch.vertex_count + batch.simplex_count() + batch.finalized.size(), 1u);
        }
      }
      EXPECT_TRUE(batch.empty());
      EXPECT_TRUE(test::same(checker.cells, golden_cells(sample.file)));
      const bool post_order = open_bytes(bytes, sample.file)->header().post_order;
      if (post_order) {
        EXPECT_EQ(checker.final.size(), checker.arrived.size());
      }
      const auto& warnings = reader->warnings();
      const bool told = std::any_of(warnings.begin(), warnings.end(),
                                    [](const auto& text) { return text.ends_with("were never finalized"); });
      EXPECT_EQ(told, checker.final.size() < checker.arrived.size());
    }
  }
}

TEST(StreamMeshReader, EventsOfPreOrderFilesAreThoseOfTheFile) {
  for (const Sample& sample : all_samples()) {
    if (!sample.good()) continue;
    const std::string bytes = sample_bytes(sample.file);
    const auto raw = open_bytes(bytes, sample.file);
    if (raw->header().post_order || raw->header().volume) continue;
    EXPECT_TRUE(test::same(events_of(*open_mesh_bytes(sample, bytes, 1)), golden_events(sample.file))) << sample.file;
  }
}

TEST(StreamMeshReader, APostOrderCellComesWithItsLastVertexAndThenTheFinalizations) {
  const std::string bytes = "f 1 3 2\nf 3 2 2\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\n";
  const auto reader = make_stream_mesh_reader(open_bytes(bytes), {.properties = {}, .batch_events = 1});
  EXPECT_EQ(events_of(*reader), "v 0 0 0 0\nv 1 1 0 0\nv 2 0 1 0\nt 0 2 1\nf 0\nt 2 1 1\nf 2\nf 1\nv 3 5 5 5\nf 3\n");
}

// As in all other formats, or the positions of nodes would depend on the format.
TEST(StreamMeshReader, DeliversMinusZeroOnlyIfAsked) {
  const std::string bytes = "v -0 1 0\nv 1 0 1\nv 0 1 2\nf 1 2 3\n";
  for (const bool asked : {false, true}) {
    ReadOptions options;
    options.signed_zeros = asked;
    const auto reader = make_stream_mesh_reader(open_bytes(bytes), options);
    MeshBatch batch;
    ASSERT_TRUE(reader->read(batch));
    EXPECT_EQ(std::signbit(batch.coordinates[0][0]), asked);
  }
}

TEST(StreamMeshReader, ScalarsAreProperties) {
  const std::string bytes =
      "# v_pnum_f 4\n# v_pnum_i 2\nv 0 0 0 2.5 7 8\nv 1 0 0 3.5 -7 9\nv 0 1 0 1 1 1\n"
      "v 0 0 1 1 1 1\nc -1 -2 -3 -4\n";
  ReadOptions options;
  options.properties = {"i1", "s0"};
  const auto reader = make_stream_mesh_reader(open_bytes(bytes), options);
  EXPECT_EQ(reader->info().property_names, (std::vector<std::string>{"s0", "i0", "i1"}));
  MeshBatch batch;
  ASSERT_TRUE(reader->read(batch));
  EXPECT_EQ(batch.properties[0], (std::vector<double>{8, 9, 1, 1}));
  EXPECT_EQ(batch.properties[1], (std::vector<double>{2.5, 3.5, 1, 1}));
  EXPECT_EQ(batch.tetrahedra().size(), 4u);
  EXPECT_EQ(batch.finalized.size(), 4u);
  options.properties = {"pressure"};
  EXPECT_THROW(make_stream_mesh_reader(open_bytes(bytes), options), Error);
}

// Three corners of 4 bytes each is the least that a waiting cell takes.
TEST(StreamMeshReader, TellsWhatItHoldsBackWhileItDoes) {
  constexpr std::uint64_t kCells = 200000, kBytes = 12;
  std::string bytes;
  for (std::uint64_t i = 0; i < kCells; ++i) bytes += "f 1 2 3\n";
  bytes += "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto reader = make_stream_mesh_reader(open_bytes(bytes));
  std::vector<std::uint64_t> held;
  std::uint64_t triangles = 0;
  for (MeshBatch batch; reader->read(batch);) {
    held.push_back(reader->memory_bytes());
    triangles += batch.triangle_count();
  }
  EXPECT_EQ(triangles, kCells);
  ASSERT_GE(held.size(), 3u);
  EXPECT_LT(2 * held[0], held[2]);
  EXPECT_GE(held.back(), kCells * kBytes);
}

// A square grid that is never finalized: all vertices and the edges of its rim stay open.
TEST(StreamMeshReader, TellsTheFrontOfACompressedStream) {
  std::string text;
  constexpr std::uint32_t kSide = 100;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  for (std::uint32_t a = 1; a + kSide < kSide * kSide; ++a)
    if (a % kSide != 0)
      text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + kSide) + "\n";
  const auto source = open_bytes(text);
  std::ostringstream packed;
  const auto writer = make_smc_writer(packed, source->header());
  while (const StreamEvent* event = source->next()) writer->write(*event);
  writer->close();
  const std::string bytes = packed.str();
  const auto reader = make_stream_mesh_reader(open_bytes(bytes));
  for (MeshBatch batch; reader->read(batch);) continue;
  // An index and a position each.
  EXPECT_GE(reader->memory_bytes(), std::uint64_t{kSide} * (kSide - 1) * 16);
}

}  // namespace
}  // namespace reeb::io
