// Meshes whose pieces are read in another order: the graph is that of the order of the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

constexpr const char* kReadInPieces = "pieces, read in another order";

using Polygon = std::vector<std::int32_t>;

// A surface of blocks of two cells: a pentagon and a triangle, two quads, or a quad and two triangles. Its blocks come
// tile by tile, the tiles in random order.
std::vector<Polygon> polygons_in_random_tiles(std::int32_t columns, std::int32_t rows) {
  constexpr std::int32_t kTileColumns = 8, kTileRows = 8;
  std::vector<std::vector<Polygon>> tiles;
  std::mt19937 random(7);
  for (std::int32_t y = 0; y + 1 < rows; y += kTileRows)
    for (std::int32_t x = 0; x + 2 < columns; x += kTileColumns) {
      auto& tile = tiles.emplace_back();
      for (std::int32_t j = y; j < std::min(y + kTileRows, rows - 1); ++j)
        for (std::int32_t i = x; i < std::min(x + kTileColumns, columns - 1); i += 2) {
          const std::int32_t a = j * columns + i, b = a + 1, c = a + 2, d = a + columns, e = d + 1, f = d + 2;
          switch (random() % 3) {
            case 0:
              tile.insert(tile.end(), {{a, b, c, e, d}, {c, f, e}});
              break;
            case 1:
              tile.insert(tile.end(), {{a, b, e, d}, {b, c, f, e}});
              break;
            default:
              tile.insert(tile.end(), {{a, b, e, d}, {b, c, f}, {b, f, e}});
          }
        }
    }
  std::shuffle(tiles.begin(), tiles.end(), random);
  std::vector<Polygon> all;
  for (const auto& tile : tiles) all.insert(all.end(), tile.begin(), tile.end());
  return all;
}

std::vector<Polygon> fans_of(const std::vector<Polygon>& polygons) {
  std::vector<Polygon> triangles;
  for (const Polygon& polygon : polygons)
    for (std::size_t k = 2; k < polygon.size(); ++k) triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  return triangles;
}

template <class T>
void put(std::string& bytes, T value) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof(T));
  std::memcpy(bytes.data() + end, &value, sizeof(T));
}

std::string ply_of(std::int32_t columns, std::int32_t rows, const std::vector<Polygon>& polygons) {
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(columns * rows) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                    std::to_string(polygons.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  std::mt19937 random(11);
  for (std::int32_t v = 0; v < columns * rows; ++v) {
    put(ply, static_cast<float>(v % columns));
    put(ply, static_cast<float>(v / columns));
    put(ply, static_cast<float>(random() % 100'000) / 1000);
  }
  for (const Polygon& polygon : polygons) {
    put(ply, static_cast<std::uint8_t>(polygon.size()));
    for (const std::int32_t corner : polygon) put(ply, corner);
  }
  return ply;
}

class MeshOrder : public ProgramTest {
 protected:
  // The bytes of the graph of `mesh`, and what was said.
  struct Run {
    std::string bytes, notes;
  };
  Run graph_of(const std::string& mesh, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"compute", mesh, "-o", "out.reeb", "--force", "--graph-only", "--buckets", "0"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = reeb(words);
    expect_success(outcome);
    return {file("out.reeb"), outcome.error};
  }
};

TEST_F(MeshOrder, OfMixedPolygonsInPiecesGivesTheSameGraph) {
  constexpr std::int32_t kColumns = 321, kRows = 241;
  const std::vector<Polygon> polygons = polygons_in_random_tiles(kColumns, kRows);
  write("mixed.ply", ply_of(kColumns, kRows, polygons));
  write("triangles.ply", ply_of(kColumns, kRows, fans_of(polygons)));
  const Run pieces = graph_of("mixed.ply", {"--memory", "64M"}), as_it_is = graph_of("mixed.ply", {"--no-reorder"});
  const Run of_triangles = graph_of("triangles.ply", {"--no-reorder"});
  EXPECT_NE(pieces.notes.find(kReadInPieces), std::string::npos) << pieces.notes;
  EXPECT_TRUE(pieces.bytes == of_triangles.bytes);
  EXPECT_TRUE(as_it_is.bytes == of_triangles.bytes);
}

// The sidecar is of the order of the file.
TEST_F(MeshOrder, OfPiecesLeavesASidecarThatFits) {
  expect_success(reeb({"generate", "scan", "--triangles", "100k", "--order", "random-tiles:8", "-o", "mesh.ply"}));
  const std::string expected = graph_of("mesh.ply", {"--no-reorder"}).bytes;
  const std::vector<std::string> limit = {"--memory", "24M"};
  const Run keeps = graph_of("mesh.ply", {"--memory", "24M", "--sidecar"});
  EXPECT_NE(keeps.notes.find(kReadInPieces), std::string::npos) << keeps.notes;
  EXPECT_TRUE(keeps.bytes == expected);
  const std::string sidecar = file("mesh.ply.final");
  for (const std::vector<std::string>& options : {limit, std::vector<std::string>{}, {"--no-reorder"}}) {
    const Run uses = graph_of("mesh.ply", options);
    EXPECT_TRUE(uses.bytes == expected) << last_command();
    EXPECT_EQ(uses.notes.find("ignored"), std::string::npos) << uses.notes;
    EXPECT_TRUE(file("mesh.ply.final") == sidecar);
  }
  const Run pieces = graph_of("mesh.ply", limit);
  EXPECT_NE(pieces.notes.find(kReadInPieces), std::string::npos) << pieces.notes;
}

}  // namespace
}  // namespace reeb::test
