// Writers: a file gives back what was written, and failures leave nothing behind.
#include "io/formats/create_mesh.h"
#include "io/formats/open_mesh.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>

#include "io/generate/generator.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;

struct Mesh {
  std::vector<std::vector<double>> vertices;  // columns of each vertex
  std::vector<std::vector<std::uint64_t>> faces;
  friend bool operator==(const Mesh&, const Mesh&) = default;
};

void copy_mesh(MeshReader& reader, MeshWriter& writer) {
  for (MeshBatch batch; reader.read(batch);) writer.write(batch);
  writer.close();
}

class Writers : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("reeb_writers_" + std::to_string(::getpid()));
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

// Vertices and faces alternate; with a property, a point, an edge, a degenerate triangle and a tetrahedron.
std::vector<MeshBatch> interleaved() {
  MeshBatch first, second;
  first.vertex_count = 4;
  first.coordinates = {{0, 1, 0.1, -2.5}, {0, 0, 1e-3, 1}, {0, -0.0, 7, 1}};
  first.properties = {{4, 5, 6, 7}};
  first.points() = {VertexId(2)};
  first.edges() = {VertexId(3), VertexId(1)};
  first.triangles() = {VertexId(0), VertexId(1), VertexId(2), VertexId(1), VertexId(1), VertexId(3)};
  second.first_vertex = VertexId(4);
  second.vertex_count = 1;
  second.coordinates = {{9}, {8}, {16777216}};
  second.properties = {{-1}};
  second.tetrahedra() = {VertexId(1), VertexId(2), VertexId(3), VertexId(4)};
  return {first, second};
}

Mesh expected_mesh(bool with_property, bool as_float) {
  Mesh mesh;
  mesh.faces = {{2}, {3, 1}, {0, 1, 2}, {1, 1, 3}, {1, 2, 3}, {1, 2, 4}, {1, 3, 4}, {2, 3, 4}};
  for (const MeshBatch& batch : interleaved())
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      std::vector<double> row;
      for (const auto& column : batch.coordinates) row.push_back(column[i]);
      if (with_property) row.push_back(batch.properties[0][i]);
      if (as_float)
        for (double& x : row) x = static_cast<double>(static_cast<float>(x));
      mesh.vertices.push_back(row);
    }
  return mesh;
}

template <class Number>
Number take(std::istream& in) {
  std::array<char, sizeof(Number)> bytes{};
  in.read(bytes.data(), bytes.size());
  Number number;
  std::memcpy(&number, bytes.data(), bytes.size());
  return number;
}

Mesh parse_ply(const std::string& path, std::string* header = nullptr) {
  std::ifstream in(path, std::ios::binary);
  Mesh mesh;
  std::size_t vertices = 0, faces = 0;
  std::vector<bool> is_float;
  for (std::string line; std::getline(in, line) && line != "end_header";) {
    if (header != nullptr) *header += line + "\n";
    std::istringstream words(line);
    std::string word, kind;
    words >> word >> kind;
    if (word == "element") words >> (kind == "vertex" ? vertices : faces);
    if (word == "property" && kind != "list") is_float.push_back(kind == "float");
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    mesh.vertices.emplace_back();
    for (const bool narrow : is_float)
      mesh.vertices.back().push_back(narrow ? static_cast<double>(take<float>(in)) : take<double>(in));
  }
  for (std::size_t i = 0; i < faces; ++i) {
    mesh.faces.emplace_back(take<std::uint8_t>(in));
    for (auto& corner : mesh.faces.back()) corner = take<std::uint32_t>(in);
  }
  EXPECT_TRUE(in.good());
  EXPECT_EQ(in.peek(), std::char_traits<char>::eof()) << "bytes after the last face";
  return mesh;
}

Mesh parse_obj(const std::string& path) {
  std::ifstream in(path);
  Mesh mesh;
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '#') continue;
    std::istringstream words(line.substr(1));
    if (line[0] == 'v')
      mesh.vertices.emplace_back(std::istream_iterator<double>(words), std::istream_iterator<double>());
    else
      mesh.faces.emplace_back(std::istream_iterator<std::uint64_t>(words), std::istream_iterator<std::uint64_t>());
  }
  for (auto& face : mesh.faces)
    for (auto& corner : face) --corner;
  return mesh;
}

Mesh parse_off(const std::string& path) {
  std::ifstream in(path);
  std::string magic;
  std::size_t dimension = 3, vertices = 0, faces = 0, edges = 0;
  in >> magic;
  if (magic == "nOFF") in >> dimension;
  in >> vertices >> faces >> edges;
  Mesh mesh;
  mesh.vertices.assign(vertices, std::vector<double>(dimension));
  for (auto& row : mesh.vertices)
    for (double& x : row) in >> x;
  for (std::size_t i = 0, corners = 0; i < faces && in >> corners; ++i) {
    mesh.faces.emplace_back(corners);
    for (auto& corner : mesh.faces.back()) in >> corner;
  }
  EXPECT_TRUE(in.good());
  return mesh;
}

void write_interleaved(const std::string& path, const MeshWriterOptions& options) {
  const auto writer = create_mesh(path, options);
  for (const MeshBatch& batch : interleaved()) writer->write(batch);
  EXPECT_FALSE(fs::exists(path)) << "visible before it is whole";
  writer->close();
}

ErrorKind kind_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_FALSE(error.hint().empty());
    return error.kind();
  }
  return ErrorKind::kInterrupted;  // nothing was thrown
}

TEST_F(Writers, PlyKeepsInterleavedMeshesAndProperties) {
  for (const bool float64 : {false, true}) {
    const std::string file = path(float64 ? "d.ply" : "f.ply");
    write_interleaved(file, {.property_names = {"heat"}, .float64 = float64});
    std::string header;
    EXPECT_EQ(parse_ply(file, &header), expected_mesh(true, !float64));
    EXPECT_NE(header.find("property " + std::string(float64 ? "double" : "float") + " heat\n"), header.npos);
    EXPECT_NE(header.find("property list uchar int vertex_indices\n"), header.npos);
  }
  EXPECT_EQ(files(), 2u) << "a temporary file was left";
}

TEST_F(Writers, PlyHasNoNameTwiceAndNoneWithABlank) {
  MeshWriterOptions options;
  options.property_names = {"x", "heat (K)", "heat_(K)", ""};
  const auto writer = create_mesh(path("names.ply"), options);
  MeshBatch batch;
  batch.vertex_count = 1;
  batch.coordinates.assign(3, {0});
  batch.properties.assign(4, {7});
  writer->write(batch);
  writer->close();
  const auto reader = open_mesh(path("names.ply"));
  EXPECT_EQ(reader->info().property_names, (std::vector<std::string>{"x_", "heat_(K)", "heat_(K)_", "_"}));
}

TEST_F(Writers, ObjAndOffKeepInterleavedMeshesExactly) {
  write_interleaved(path("a.obj"), {});
  EXPECT_EQ(parse_obj(path("a.obj")), expected_mesh(false, false));
  write_interleaved(path("a.OFF"), {});
  EXPECT_EQ(parse_off(path("a.OFF")), expected_mesh(false, false));
  EXPECT_EQ(files(), 2u);
}

TEST_F(Writers, EveryFormatHoldsTheSameGeneratedMesh) {
  // Larger than the write buffer, with and without an announced vertex count.
  const auto write = [this](const std::string& name, bool promise) {
    const auto mesh = generate_mesh({.kind = MeshKind::kScan, .triangles = 150'000});
    MeshWriterOptions options;
    if (promise) options.vertex_count = mesh->info().vertex_count;
    copy_mesh(*mesh, *create_mesh(path(name), options));
  };
  write("a.ply", true);
  write("b.ply", false);
  write("a.obj", true);
  write("a.off", false);
  const Mesh mesh = parse_ply(path("a.ply"));
  EXPECT_GT(fs::file_size(path("a.ply")), 2 * BufferedWriter::kBufferBytes);
  EXPECT_TRUE(mesh == parse_ply(path("b.ply")));
  EXPECT_TRUE(mesh == parse_obj(path("a.obj")));
  EXPECT_TRUE(mesh == parse_off(path("a.off")));
}

TEST_F(Writers, FurtherCoordinatesAreKeptWhereTheFormatCan) {
  const GeneratorOptions simplex{.kind = MeshKind::kSierpinski, .triangles = 1000, .dimension = 5};
  for (const char* name : {"s.ply", "s.off"})
    copy_mesh(*generate_mesh(simplex), *create_mesh(path(name), {.dimension = 5}));
  const Mesh mesh = parse_ply(path("s.ply"));
  EXPECT_EQ(mesh.vertices[5], (std::vector<double>{0, 0, 0, 0, 4})) << "corner 5 of two levels";
  EXPECT_TRUE(mesh == parse_off(path("s.off")));
  EXPECT_EQ(kind_of([&] { create_mesh(path("s.obj"), {.dimension = 5}); }), ErrorKind::kBadInput);
}

TEST_F(Writers, AnEmptyMeshIsAFileToo) {
  for (const char* name : {"e.ply", "e.obj"}) create_mesh(path(name))->close();
  EXPECT_EQ(parse_ply(path("e.ply")), Mesh{});
  EXPECT_EQ(parse_obj(path("e.obj")), Mesh{});
}

TEST_F(Writers, AnExistingOutputIsReplacedOnlyOnRequest) {
  std::ofstream(path("a.ply")) << "mine";
  EXPECT_EQ(kind_of([&] { create_mesh(path("a.ply")); }), ErrorKind::kBadInput);
  // Another process creates the file while it is being written.
  const auto late = create_mesh(path("b.ply"));
  std::ofstream(path("b.ply")) << "mine";
  EXPECT_EQ(kind_of([&] { late->close(); }), ErrorKind::kBadInput);
  EXPECT_EQ(fs::file_size(path("a.ply")), 4u);
  EXPECT_EQ(fs::file_size(path("b.ply")), 4u);
  write_interleaved(path("c.ply"), {.property_names = {"heat"}});
  create_mesh(path("c.ply"), {.existing = Existing::kReplace})->close();
  EXPECT_EQ(parse_ply(path("c.ply")), Mesh{});
}

TEST_F(Writers, AnAbandonedOutputLeavesNothing) {
  for (const char* name : {"a.ply", "a.obj", "a.off"}) {
    const auto writer = create_mesh(path(name));
    writer->write(interleaved()[0]);
    EXPECT_EQ(files(), 1u);
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(Writers, AFullDiskAndAMissingFolderAreResourceErrors) {
  EXPECT_EQ(kind_of([&] { create_mesh(path("none/a.ply")); }), ErrorKind::kResource);
  EXPECT_EQ(kind_of([&] { create_mesh("/proc/a.ply"); }), ErrorKind::kResource);
  for (const char* name : {"full.ply", "full.obj", "full.off"}) {
    fs::create_symlink("/dev/full", path(name));
    EXPECT_EQ(kind_of([&] {
                const auto mesh = generate_mesh({.kind = MeshKind::kGrid, .triangles = 1000});
                copy_mesh(*mesh, *create_mesh(path(name)));
              }),
              ErrorKind::kResource);
    EXPECT_TRUE(fs::is_symlink(path(name)));
  }
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(files(), 3u);
}

TEST_F(Writers, WhatTheFormatCannotHoldIsRefused) {
  EXPECT_EQ(kind_of([&] { create_mesh(path("a.xyz")); }), ErrorKind::kUsage);
  EXPECT_EQ(kind_of([&] { create_mesh(folder_.string() + "/"); }), ErrorKind::kUsage);
  fs::create_directory(path("folder.ply"));
  EXPECT_EQ(kind_of([&] { create_mesh(path("folder.ply")); }), ErrorKind::kBadInput);
  MeshBatch far = interleaved()[0];
  far.properties.clear();
  far.coordinates[0][2] = 1e300;
  try {
    create_mesh(path("a.ply"))->write(far);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(error.file(), path("a.ply"));
  }
  EXPECT_EQ(kind_of([&] { create_mesh(path("a.ply"), {.vertex_count = 3})->write(interleaved()[0]); }),
            ErrorKind::kBadInput);
}

}  // namespace
}  // namespace reeb::io
