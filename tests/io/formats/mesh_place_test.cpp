// Places in a mesh to which it can return: the triangles after a place are the same each time.
#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "tests/io/formats/mesh_files.h"

namespace reeb::io {
namespace {

using testing::scalar_bytes;

// Faces of up to `most` corners, with a property before and one after the list if `extra`.
std::string polygons(std::uint64_t seed, std::size_t most, bool extra, bool big_endian) {
  std::mt19937_64 random(seed);
  constexpr std::uint32_t kVertices = 300, kFaces = 2000;
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement vertex " + std::to_string(kVertices) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(kFaces) +
                      "\n" + (extra ? "property float weight\n" : "") + "property list uchar int vertex_indices\n" +
                      (extra ? "property ushort group\n" : "") +
                      "element other 3\nproperty list uchar char names\nend_header\n";
  for (std::uint32_t v = 0; v < kVertices; ++v)
    for (std::uint32_t k = 0; k < 3; ++k) bytes += scalar_bytes(static_cast<float>(v * k), big_endian);
  for (std::uint32_t f = 0; f < kFaces; ++f) {
    if (extra) bytes += scalar_bytes(1.5f, big_endian);
    const auto corners = static_cast<std::uint8_t>(most == 3 ? 3 : random() % (most + 1));
    bytes += scalar_bytes(corners);
    for (std::uint8_t c = 0; c < corners; ++c)
      bytes += scalar_bytes(static_cast<std::int32_t>(random() % kVertices), big_endian);
    if (extra) bytes += scalar_bytes(std::uint16_t{7}, big_endian);
  }
  for (int i = 0; i < 3; ++i) bytes += scalar_bytes(std::uint8_t{2}) + "ab";
  return bytes;
}

void expect_places(const std::string& path, std::uint64_t seed) {
  const auto mesh = open_mesh(path)->indexed();
  ASSERT_NE(mesh, nullptr);
  std::mt19937_64 random(seed);
  std::vector<VertexId> all, some;
  std::vector<std::pair<MeshPlace, std::size_t>> places;
  mesh->rewind();
  do {
    const auto place = mesh->place();
    ASSERT_TRUE(place.has_value());
    places.emplace_back(*place, all.size());
    all.insert(all.end(), some.begin(), some.end());
    places.back().second = all.size();
  } while (mesh->read(some, 1 + random() % 9));
  ASSERT_GT(places.size(), 300u);
  for (int trial = 0; trial < 500; ++trial) {
    const auto& [place, at] = places[random() % places.size()];
    mesh->seek(place);
    EXPECT_EQ(mesh->place(), place);
    std::size_t end = at;
    for (int read = 0; read < 3 && mesh->read(some, 1 + random() % 70); ++read) {
      ASSERT_LE(end + some.size(), all.size());
      ASSERT_TRUE(std::equal(some.begin(), some.end(), all.begin() + static_cast<std::ptrdiff_t>(end)));
      end += some.size();
    }
    if (end == at) {
      EXPECT_EQ(at, all.size());
    }
  }
}

TEST(MeshPlace, APlyReturnsToAnyTriangle) {
  std::uint64_t seed = 0;
  for (const std::size_t most : {3u, 4u, 9u, 100u})
    for (const bool extra : {false, true})
      for (const bool big_endian : {false, true}) {
        SCOPED_TRACE(::testing::Message() << most << " corners, extra " << extra << ", big endian " << big_endian);
        ++seed;
        expect_places(testing::write_file("places.ply", polygons(seed, most, extra, big_endian)), seed);
      }
}

// A strip would have to be read again from its beginning.
TEST(MeshPlace, ThereIsNoneFarWithinAStrip) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  bytes += std::string(36, '\0') + scalar_bytes(std::int32_t{100'000});
  for (std::int32_t c = 0; c < 100'000; ++c) bytes += scalar_bytes(c % 3);
  const auto mesh = open_mesh(testing::write_file("strip.ply", bytes))->indexed();
  ASSERT_NE(mesh, nullptr);
  std::vector<VertexId> some;
  mesh->rewind();
  EXPECT_TRUE(mesh->place().has_value());
  ASSERT_TRUE(mesh->read(some, 1000));
  EXPECT_TRUE(mesh->place().has_value());
  for (int i = 0; i < 80; ++i) ASSERT_TRUE(mesh->read(some, 1000));
  EXPECT_FALSE(mesh->place().has_value());
}

}  // namespace
}  // namespace reeb::io
