// `reeb compute` on real meshes against the results of an independent program (EXPECTED.tsv in the same folder): from
// the file, from standard input, and with shuffled triangles. The largest meshes are skipped unless REEB_TEST_ALL is
// set.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/formats/create_mesh.h"
#include "io/formats/open_mesh.h"
#include "libreeb/base/error.h"
#include "tests/support/data.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

struct Expected {
  std::string function;
  std::map<std::string, std::uint64_t> counts;  // by the header of the table
  std::string rg_sha256;
};

using Table = std::map<std::string, std::vector<Expected>>;  // by file

Table read_table() {
  Table table;
  std::istringstream lines(read_file(mesh_folder() + "/EXPECTED.tsv"));
  std::string line, word;
  std::vector<std::string> header;
  while (std::getline(lines, line)) {
    std::istringstream text(line);
    std::vector<std::string> words;
    while (std::getline(text, word, '\t')) words.push_back(word);
    if (header.empty()) {
      header = words;
      continue;
    }
    Expected expected{words[1], {}, words.back()};
    for (std::size_t i = 2; i + 1 < words.size(); ++i) expected.counts[header[i]] = std::stoull(words[i]);
    table[words[0]].push_back(expected);
  }
  return table;
}

// The front of a tetrahedral mesh is a surface, so four functions at once exceed the least memory, and in random order
// it is most of the mesh.
bool has_narrow_front(const std::string& name) { return name.find("_tets.") == std::string::npos; }

std::vector<std::string> meshes_to_run() {
  constexpr const char* kLargest[] = {"ct_head_iso60.ply.gz", "etopo20_terrain.ply.gz", "dragon_vrip.ply.gz",
                                      "bluntfin_tets.vtk.gz"};
  std::vector<std::string> names;
  for (const auto& [name, results] : read_table()) {
    if (memory_limit() && !has_narrow_front(name)) continue;
    if (std::getenv("REEB_TEST_ALL") != nullptr ||
        std::find(std::begin(kLargest), std::end(kLargest), name) == std::end(kLargest))
      names.push_back(name);
  }
  return names;
}

std::vector<std::string> surfaces_to_run() {
  std::vector<std::string> names = meshes_to_run();
  std::erase_if(names, [](const std::string& name) { return !has_narrow_front(name); });
  return names;
}

class RealMesh : public ProgramTest, public testing::WithParamInterface<std::string> {
 protected:
  // Computes all functions of the table in one run and compares each.
  void check(const std::string& mesh, const std::string& input = "/dev/null") {
    const std::vector<Expected> all = read_table().at(GetParam());
    std::vector<std::string> words = {"compute", mesh, "-o", "out", "--report", "report.json", "--force"};
    for (const Expected& expected : all) words.insert(words.end(), {"-f", expected.function});
    Command command;
    command.input = input;
    const Outcome outcome = reeb(words, command);
    ASSERT_EQ(outcome.exit_code, 0) << last_command() << '\n' << outcome.error;
    const auto reports = nlohmann::json::parse(file("report.json"));
    ASSERT_EQ(reports.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) compare(reports[i], all[i]);
  }

 private:
  void compare(const nlohmann::json& report, const Expected& expected) {
    SCOPED_TRACE(last_command() + "\nf = " + expected.function);
    EXPECT_EQ(report.at("function").at("name"), expected.function);
    for (const auto& [name, count] : expected.counts) {
      const bool is_pair_type = report.at("pairs").contains(name);
      EXPECT_EQ(report.at(is_pair_type ? "pairs" : "graph").at(name).get<std::uint64_t>(), count) << name;
    }
    const Outcome graph = reeb({"extract", report.at("output").get<std::string>()});
    expect_success(graph);
    EXPECT_EQ(sha256_without_comments(graph.output), expected.rg_sha256);
  }

  std::string sha256_without_comments(const std::string& rg) const {
    std::string bytes;
    std::istringstream lines(rg);
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with('#')) bytes.append(line).push_back('\n');
    write("graph.rg", bytes);
    const Outcome digest = run_process({.arguments = {"sha256sum", in_folder("graph.rg")}});
    return digest.output.substr(0, 64);
  }
};

TEST_P(RealMesh, FromTheFile) { check(mesh_folder() + "/" + GetParam()); }

TEST_P(RealMesh, FromStandardInput) { check("-", mesh_folder() + "/" + GetParam()); }

// The same vertices, then all triangles in random order, as binary PLY.
void write_shuffled(const std::string& from, const std::string& to, std::uint64_t seed) {
  const auto reader = io::open_mesh(from);
  MeshBatch batch, mesh;
  mesh.coordinates.resize(reader->info().dimension);
  std::vector<std::array<VertexId, 3>> triangles;
  while (reader->read(batch)) {
    ASSERT_EQ(batch.simplex_count(), batch.triangle_count());
    mesh.vertex_count += batch.vertex_count;
    for (std::size_t k = 0; k < mesh.coordinates.size(); ++k)
      mesh.coordinates[k].insert(mesh.coordinates[k].end(), batch.coordinates[k].begin(), batch.coordinates[k].end());
    for (std::size_t c = 0; c < batch.triangles().size(); c += 3)
      triangles.push_back({batch.triangles()[c], batch.triangles()[c + 1], batch.triangles()[c + 2]});
  }
  Random(seed).shuffle(triangles);
  for (const auto& corners : triangles) mesh.triangles().insert(mesh.triangles().end(), corners.begin(), corners.end());
  io::MeshWriterOptions options;
  options.dimension = reader->info().dimension;
  options.float64 = true;
  options.vertex_count = mesh.vertex_count;
  const auto writer = io::create_mesh(to, options);
  writer->write(mesh);
  writer->close();
}

class RealSurface : public RealMesh {};

TEST_P(RealSurface, WithItsTrianglesShuffled) {
  ASSERT_NO_FATAL_FAILURE(write_shuffled(mesh_folder() + "/" + GetParam(), in_folder("shuffled.ply"), base_seed()));
  check("shuffled.ply");
}

std::string test_name(const testing::TestParamInfo<std::string>& mesh) {
  std::string name = mesh.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealMesh, testing::ValuesIn(meshes_to_run()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealMesh);
INSTANTIATE_TEST_SUITE_P(Meshes, RealSurface, testing::ValuesIn(surfaces_to_run()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealSurface);

// Otherwise a folder with other files would run no test, and so pass.
TEST(RealMeshes, AreThere) {
  REEB_REQUIRE_MESHES();
  const Table table = read_table();
  EXPECT_GE(table.size(), 20u) << "in " << mesh_folder();
  for (const auto& [name, results] : table)
    EXPECT_TRUE(std::filesystem::exists(mesh_folder() + "/" + name)) << name << " in " << mesh_folder();
}

}  // namespace
}  // namespace reeb::test
