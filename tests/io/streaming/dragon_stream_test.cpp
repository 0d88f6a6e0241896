// A large scan, written in each streaming format and read back. Every bit of every coordinate is kept, and so is the
// order of triangles and finalizations.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <sstream>

#include "io/events/stream_writer.h"
#include "io/formats/open_mesh.h"
#include "tests/io/streaming/samples.h"
#include "tests/support/data.h"

namespace reeb::io {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

using Position = std::array<std::uint32_t, 3>;  // bits of x, y, z
using Corners = std::array<std::uint32_t, 3>;

struct Scan {
  std::vector<Position> positions;
  std::vector<Corners> triangles;
  std::vector<std::uint32_t> first, last;  // the triangles of a vertex; kNone: it has none
};

Scan read_scan(const std::string& path) {
  Scan scan;
  const auto reader = open_mesh(path);
  MeshBatch batch;
  while (reader->read(batch)) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      Position& position = scan.positions.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        position[k] = std::bit_cast<std::uint32_t>(static_cast<float>(batch.coordinates[k][i]));
    }
    for (std::size_t t = 0; t < batch.triangles().size(); t += 3) {
      Corners& corners = scan.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) corners[k] = static_cast<std::uint32_t>(batch.triangles()[t + k].value());
    }
  }
  scan.first.assign(scan.positions.size(), kNone);
  scan.last.assign(scan.positions.size(), kNone);
  for (std::uint32_t t = 0; t < scan.triangles.size(); ++t)
    for (const std::uint32_t v : scan.triangles[t]) {
      if (scan.first[v] == kNone) scan.first[v] = t;
      scan.last[v] = t;
    }
  return scan;
}

// Writes each vertex directly before its first triangle, and finalizes it directly after its last.
void write_compact(const Scan& scan, StreamWriter& writer) {
  std::vector<std::uint32_t> number(scan.positions.size(), kNone);
  std::uint32_t numbered = 0;
  StreamEvent event{};
  for (std::uint32_t t = 0; t < scan.triangles.size(); ++t) {
    for (const std::uint32_t v : scan.triangles[t]) {
      if (number[v] != kNone) continue;
      event.kind = EventKind::kVertex;
      event.vertex = number[v] = numbered++;
      for (std::size_t k = 0; k < 3; ++k) event.floats[k] = std::bit_cast<float>(scan.positions[v][k]);
      writer.write(event);
    }
    event.kind = EventKind::kTriangle;
    for (std::size_t k = 0; k < 3; ++k) event.corners[k] = number[scan.triangles[t][k]];
    writer.write(event);
    event.kind = EventKind::kFinalized;
    for (const std::uint32_t v : scan.triangles[t]) {
      if (scan.last[v] != t) continue;
      event.vertex = number[v];
      writer.write(event);
    }
  }
  writer.close();
}

// Follows a stream with the same triangles. It may renumber vertices and rotate the corners of a triangle.
class Comparison {
 public:
  explicit Comparison(const Scan& scan) : scan_(scan), final_(scan.positions.size()) {}

  void take(const StreamEvent& event) {
    if (event.kind == EventKind::kVertex) take_vertex(event);
    if (event.kind == EventKind::kTriangle) take_triangle(event);
    if (event.kind == EventKind::kFinalized) take_finalized(event.vertex);
  }
  void end() const {
    EXPECT_EQ(triangles_, scan_.triangles.size());
    for (std::size_t v = 0; v < scan_.positions.size(); ++v)
      ASSERT_EQ(final_[v], scan_.last[v] != kNone) << "vertex " << v;
  }

 private:
  void take_vertex(const StreamEvent& event) {
    ASSERT_EQ(event.vertex, positions_.size());
    positions_.push_back({});
    original_.push_back(kNone);
    for (std::size_t k = 0; k < 3; ++k) positions_.back()[k] = std::bit_cast<std::uint32_t>(event.floats[k]);
  }

  void take_triangle(const StreamEvent& event) {
    ASSERT_LT(triangles_, scan_.triangles.size());
    const Corners& expected = scan_.triangles[triangles_++];
    for (std::size_t turn = 0; turn < 3; ++turn)
      if (agrees(event, expected, turn)) {
        for (std::size_t k = 0; k < 3; ++k) original_[event.corners[k]] = expected[(k + turn) % 3];
        return;
      }
    FAIL() << "triangle " << triangles_ - 1 << " has other corners";
  }

  bool agrees(const StreamEvent& event, const Corners& expected, std::size_t turn) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = event.corners[k], w = expected[(k + turn) % 3];
      if (original_[v] != kNone ? original_[v] != w : positions_[v] != scan_.positions[w]) return false;
    }
    return true;
  }

  void take_finalized(std::uint32_t vertex) {
    const std::uint32_t v = original_[vertex];
    ASSERT_NE(v, kNone);
    ASSERT_EQ(scan_.last[v], triangles_ - 1) << "vertex " << v << " is final at another moment";
    ASSERT_FALSE(final_[v]);
    final_[v] = true;
  }

  const Scan& scan_;
  std::vector<bool> final_;
  std::vector<Position> positions_;
  std::vector<std::uint32_t> original_;  // by vertex of the stream: the vertex of the scan
  std::size_t triangles_ = 0;
};

TEST(DragonStream, EveryFormatKeepsEveryBit) {
  REEB_REQUIRE_MESHES();
  const Scan scan = read_scan(test::mesh_folder() + "/dragon_vrip.ply.gz");
  ASSERT_EQ(scan.triangles.size(), 871414u);
  const std::pair<const char*, std::unique_ptr<StreamWriter> (*)(std::ostream&)> formats[] = {
      {"SMC version 3", [](std::ostream& out) { return make_smc_writer(out, {}); }},
      {"SMB little endian", [](std::ostream& out) { return make_block_writer(out, {}); }},
      {"SMA", [](std::ostream& out) { return make_text_writer(out, {}); }}};
  for (const auto& [name, make] : formats) {
    SCOPED_TRACE(name);
    std::ostringstream out;
    write_compact(scan, *make(out));
    const std::string bytes = out.str();
    std::printf("%s: %zu bytes, %.1f bits a vertex\n", name, bytes.size(),
                8.0 * static_cast<double>(bytes.size()) / static_cast<double>(scan.positions.size()));
    const auto reader = open_bytes(bytes);
    EXPECT_EQ(reader->header().format, name);
    Comparison comparison(scan);
    while (const StreamEvent* event = reader->next()) {
      comparison.take(*event);
      if (HasFatalFailure()) return;
    }
    comparison.end();
    EXPECT_TRUE(reader->warnings().empty());
  }
}

}  // namespace
}  // namespace reeb::io
