// For the tests of io: mesh files written by hand, and meshes as the readers deliver them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "io/formats/open_mesh.h"
#include "libreeb/base/error.h"

namespace reeb::io::testing {

// A folder that lives as long as the program.
inline const std::filesystem::path& scratch_folder() {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("reeb_io_test_" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
  };
  static const Folder folder;
  return folder.path;
}

inline std::string write_file(const std::string& name, const std::string& bytes) {
  const auto path = scratch_folder() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

template <class T>
std::string scalar_bytes(T value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

// A mesh without its order of events: vertices and triangles as two sequences.
struct Mesh {
  std::vector<std::vector<double>> vertices;  // coordinates, then properties
  std::vector<std::array<std::uint64_t, 3>> triangles;
  std::vector<std::vector<std::uint64_t>> edges = {}, points = {}, tetrahedra = {};
  friend bool operator==(const Mesh&, const Mesh&) = default;
};

inline void append(const MeshBatch& batch, Mesh& mesh) {
  EXPECT_EQ(batch.first_vertex.value(), mesh.vertices.size());
  for (std::size_t i = 0; i < batch.vertex_count; ++i) {
    auto& vertex = mesh.vertices.emplace_back();
    for (const auto& column : batch.coordinates) vertex.push_back(column.at(i));
    for (const auto& column : batch.properties) vertex.push_back(column.at(i));
  }
  batch.for_each_simplex([&mesh](std::span<const VertexId> corners) {
    std::vector<std::uint64_t> simplex;
    for (const VertexId v : corners) {
      EXPECT_LT(v.value(), mesh.vertices.size()) << "a corner before its vertex";
      simplex.push_back(v.value());
    }
    ASSERT_LE(simplex.size(), 4u);
    if (simplex.size() == 4)
      mesh.tetrahedra.push_back(simplex);
    else if (simplex.size() == 3)
      mesh.triangles.push_back({simplex[0], simplex[1], simplex[2]});
    else
      (simplex.size() == 2 ? mesh.edges : mesh.points).push_back(simplex);
  });
}

inline Mesh read_all(MeshReader& reader, std::size_t batch_events = 65536) {
  Mesh mesh;
  MeshBatch batch;
  while (reader.read(batch)) {
    EXPECT_LE(batch.vertex_count + batch.simplex_count(), batch_events);
    append(batch, mesh);
  }
  EXPECT_TRUE(batch.empty());
  return mesh;
}

// Reads with several batch sizes, which must not change the mesh.
inline Mesh read_mesh(const std::string& path, std::vector<std::string> properties = {}) {
  Mesh mesh;
  for (const std::size_t batch_events : {std::size_t{65536}, std::size_t{7}, std::size_t{1}}) {
    const ReadOptions options{properties, batch_events};
    Mesh same = read_all(*open_mesh(path, options), batch_events);
    if (batch_events == 65536)
      mesh = std::move(same);
    else
      EXPECT_EQ(same, mesh) << "batches of " << batch_events;
  }
  return mesh;
}

// The faces and chosen columns of an indexed mesh.
inline Mesh read_indexed(IndexedMesh& indexed) {
  Mesh mesh;
  const auto count = static_cast<std::size_t>(indexed.vertex_count());
  std::vector<VertexId> ids;
  for (std::size_t i = count; i-- > 0;) ids.emplace_back(i);  // backwards
  std::vector<unsigned> columns;
  for (unsigned k = 0; k < indexed.column_count(); ++k) columns.push_back(k);
  std::vector<double> values(ids.size() * columns.size());
  indexed.gather(ids, columns, values);
  mesh.vertices.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    for (const unsigned k : columns) mesh.vertices[count - 1 - i].push_back(values[k * count + i]);
  std::vector<VertexId> corners;
  while (indexed.read(corners, 5)) {
    EXPECT_LE(corners.size(), 15u);
    for (std::size_t t = 0; t < corners.size(); t += 3)
      mesh.triangles.push_back({corners[t].value(), corners[t + 1].value(), corners[t + 2].value()});
  }
  return mesh;
}

// Expects an error that has this position, these words in its message, and a hint.
inline void expect_bad(const std::string& path, const std::optional<std::string>& position, const std::string& words,
                       const ReadOptions& options = {}) {
  SCOPED_TRACE(path);
  try {
    const auto reader = open_mesh(path, options);
    MeshBatch batch;
    while (reader->read(batch)) {
    }
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(error.file(), path);
    EXPECT_EQ(error.position(), position.value_or(error.position())) << error.what();
    EXPECT_NE(error.message().find(words), std::string::npos) << error.what();
    EXPECT_FALSE(error.hint().empty());
  }
}

// Expects that every prefix of a file gives an error or a part of the mesh; of long files, every `step`-th.
inline void expect_prefixes_safe(const std::string& name, const std::string& bytes, std::size_t step = 1) {
  const Mesh whole = read_mesh(write_file("whole_" + name, bytes));
  for (std::size_t length = 0; length < bytes.size(); length += step) {
    SCOPED_TRACE(length);
    const std::string path = write_file("prefix_" + name, bytes.substr(0, length));
    try {
      const Mesh part = read_all(*open_mesh(path));
      EXPECT_LE(part.vertices.size(), whole.vertices.size());
      EXPECT_LE(part.triangles.size(), whole.triangles.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_FALSE(error.hint().empty()) << error.what();
      EXPECT_FALSE(error.position().empty()) << error.what();
    }
  }
}

}  // namespace reeb::io::testing
