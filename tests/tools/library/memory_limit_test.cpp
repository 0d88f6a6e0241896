// The memory of runs on meshes with many more vertices or arcs than a surface has.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

// Values in no order, from 0 to 1.
float value_of(std::uint32_t vertex) {
  return static_cast<float>((vertex * 2654435761u) >> 8) / static_cast<float>(1 << 24);
}

class PlyFile {
 public:
  PlyFile(const std::string& path, std::uint32_t vertices, std::uint32_t faces) : out_(path, std::ios::binary) {
    out_ << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  }
  void vertex(float x, float y, float z) {
    put(x);
    put(y);
    put(z);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.put(3);
    put(a);
    put(b);
    put(c);
  }

 private:
  template <class T>
  void put(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out_.write(bytes, sizeof(T));
  }
  std::ofstream out_;
};

// Each triangle is a component of its own, with three vertices.
void write_separate_triangles(const std::string& path, std::uint32_t triangles) {
  PlyFile ply(path, 3 * triangles, triangles);
  for (std::uint32_t v = 0; v < 3 * triangles; ++v)
    ply.vertex(static_cast<float>(v / 3 % 1000), static_cast<float>(v / 3000), value_of(v));
  for (std::uint32_t v = 0; v < 3 * triangles; v += 3) ply.triangle(v, v + 1, v + 2);
}

// Vertices 0 and 2 are connected by arcs of two edges each, which are written as triangles with a repeated corner.
// Vertices are numbered as triangles use them, so that all forms of the mesh have the same numbers.
void write_parallel_arcs(const std::string& path, std::uint32_t arcs) {
  PlyFile ply(path, arcs + 2, 2 * arcs);
  const auto middle = [](std::uint32_t arc) { return arc == 0 ? 1 : arc + 2; };
  ply.vertex(0, 0, -1);
  ply.vertex(0, 0, value_of(1));
  ply.vertex(0, 0, 2);
  for (std::uint32_t v = 3; v < arcs + 2; ++v)
    ply.vertex(static_cast<float>(v % 1000), static_cast<float>(v / 1000), value_of(v));
  for (std::uint32_t arc = 0; arc < arcs; ++arc) {
    ply.triangle(0, middle(arc), middle(arc));
    ply.triangle(middle(arc), 2, 2);
  }
}

struct Counts {
  std::uint64_t nodes = 0, arcs = 0, components = 0, loops = 0;
  friend bool operator==(const Counts&, const Counts&) = default;
};

class MemoryLimit : public ProgramTest {
 protected:
  static constexpr std::uint64_t kMiB = 1 << 20;

  // The forms in which a run can get the mesh that is in mesh.ply. "-" reads that file from standard input.
  std::vector<std::string> forms() {
    expect_success(reeb({"convert", "mesh.ply", "final.smb", "--finalize", "--quiet"}));
    expect_success(reeb({"convert", "mesh.ply", "mesh.sma", "--quiet"}));
    expect_success(reeb({"convert", "mesh.ply", "mesh.obj", "--quiet"}));
    return {"mesh.ply", "-", "final.smb", "mesh.sma", "mesh.obj"};
  }

  Outcome compute(const std::string& form, std::uint64_t megabytes, const std::string& threads,
                  const std::vector<std::string>& more) {
    std::vector<std::string> words = {"compute",   form,      "-o",       "out.reeb",
                                      "--force",   "--quiet", "--memory", std::to_string(megabytes) + "M",
                                      "--threads", threads,   "--report", "report.json"};
    words.insert(words.end(), more.begin(), more.end());
    Command command;
    if (form == "-") command.input = in_folder("mesh.ply");
    return reeb(words, command);
  }

  void expect_within(const Outcome& outcome, std::uint64_t megabytes) const {
    if (!kSanitized) {
      EXPECT_LE(outcome.peak_rss_bytes, megabytes * kMiB) << last_command() << '\n' << outcome.error;
    }
  }

  // Every run of the graph alone is within the limit, has these counts and writes the same bytes.
  void expect_graph(std::uint64_t megabytes, const Counts& expected) {
    std::string bytes;
    for (const std::string& form : forms())
      for (const char* threads : {"1", "2"}) {
        const Outcome outcome = compute(form, megabytes, threads, {"--graph-only", "--buckets", "0"});
        expect_success(outcome);
        expect_within(outcome, megabytes);
        if (outcome.exit_code != 0) continue;
        const auto graph = nlohmann::json::parse(file("report.json"))["graph"];
        EXPECT_EQ((Counts{graph["nodes"], graph["arcs"], graph["components"], graph["loops"]}), expected)
            << last_command();
        if (bytes.empty()) bytes = file("out.reeb");
        EXPECT_TRUE(bytes == file("out.reeb")) << last_command();
      }
  }

  // Every run with its hierarchy is within the limit and writes the bytes of a run that has all memory.
  void expect_hierarchy(std::uint64_t megabytes) {
    expect_success(compute("mesh.ply", 4096, "2", {"--buckets", "0"}));
    const std::string bytes = file("out.reeb");
    for (const char* threads : {"1", "2"}) {
      const Outcome outcome = compute("mesh.ply", megabytes, threads, {"--buckets", "0"});
      expect_success(outcome);
      expect_within(outcome, megabytes);
      EXPECT_TRUE(bytes == file("out.reeb")) << last_command();
    }
    const Outcome embedded = compute("mesh.ply", megabytes, "2", {});
    expect_success(embedded);
    expect_within(embedded, megabytes);
    expect_success(reeb({"verify", "out.reeb"}));
  }

  // A run that is done or refused, within the limit.
  void expect_done_or_refused(const Outcome& outcome, std::uint64_t megabytes) {
    expect_within(outcome, megabytes);
    if (outcome.exit_code != 0) expect_error(outcome, 3);
  }

  // What needs more memory ends with exit code 3 and says how much to allow, within the limit.
  void expect_refused(std::uint64_t megabytes, const std::vector<std::string>& more) {
    for (const char* form : {"mesh.ply", "-", "final.smb"})
      for (const char* threads : {"1", "2"}) {
        const Outcome outcome = compute(form, megabytes, threads, more);
        expect_error(outcome, 3);
        EXPECT_NE(outcome.error.find("--memory "), std::string::npos) << outcome.error;
        expect_within(outcome, megabytes);
      }
  }
};

TEST_F(MemoryLimit, HoldsForTrianglesThatShareNoVertex) {
  constexpr std::uint32_t kTriangles = 150'000;
  write_separate_triangles(in_folder("mesh.ply"), kTriangles);
  expect_graph(32, {2 * kTriangles, kTriangles, kTriangles, 0});
  expect_hierarchy(32);  // which would need 40 MB in memory
}

TEST_F(MemoryLimit, HoldsForManyParallelArcs) {
  constexpr std::uint32_t kArcs = 300'000;
  write_parallel_arcs(in_folder("mesh.ply"), kArcs);
  expect_graph(32, {2, kArcs, 1, kArcs - 1});
  for (const std::uint64_t megabytes : {48u, 64u, 80u})
    expect_done_or_refused(compute("mesh.ply", megabytes, "2", {"--graph-only"}), megabytes);
  expect_refused(32, {});
  expect_refused(20, {"--graph-only", "--buckets", "0"});
}

// How much a hierarchy needs beyond the least depends on where its steps are. With what the hint says, it is made.
TEST_F(MemoryLimit, HintsAtWhatAHierarchyNeeds) {
  expect_success(reeb({"generate", "scan", "--triangles", "1M", "-o", "mesh.ply"}));
  const std::vector<std::string> more = {"-f", "random:1"};
  for (const std::uint64_t megabytes : {20u, 32u}) {
    const Outcome outcome = compute("mesh.ply", megabytes, "2", more);
    expect_error(outcome, 3);
    std::smatch size;
    ASSERT_TRUE(std::regex_search(outcome.error, size, std::regex("allow --memory ([0-9]+)M"))) << outcome.error;
    const std::uint64_t enough = std::stoull(size[1]);
    const Outcome again = compute("mesh.ply", enough, "2", more);
    expect_success(again);
    expect_within(again, enough);
  }
}

// Values in a text file take memory, which a run reserves before it reads the mesh. It does not guess then, though the
// surface is closed.
TEST_F(MemoryLimit, HoldsForValuesOfATextFile) {
  constexpr int kVertices = 1'499'400;
  expect_success(reeb({"generate", "torus", "--triangles", "3M", "-o", "mesh.ply"}));
  std::string values;
  for (int v = 0; v < kVertices; ++v) values += std::to_string(v % 977) + '\n';
  write("values.txt", values);

  const auto guessed = [&]() -> std::uint64_t {
    return nlohmann::json::parse(file("report.json"))["guessed_vertices"];
  };
  expect_success(compute("mesh.ply", 64, "2", {"--graph-only"}));
  EXPECT_GT(guessed(), 0u);
  const std::vector<std::string> more = {"-f", "file:values.txt", "--graph-only", "--buckets", "0"};
  const Outcome outcome = compute("mesh.ply", 40, "2", more);
  expect_success(outcome);
  expect_within(outcome, 40);
  EXPECT_EQ(guessed(), 0u);
  expect_error(compute("mesh.ply", 20, "2", more), 3);  // the values need 11.4 MiB
}

// A chunk is not larger than its mesh, whatever was chosen.
TEST_F(MemoryLimit, HoldsForAnyChosenChunk) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "mesh.ply"}));
  expect_success(reeb({"compute", "mesh.ply", "-o", "out.reeb", "--quiet", "--chunk", "2000"}));
  const std::string bytes = file("out.reeb");
  for (const std::string& form : forms())
    for (const char* triangles : {"100000000", "18446744073709551615"}) {
      const Outcome outcome = compute(form, 32, "2", {"--chunk", triangles});
      expect_success(outcome);
      expect_within(outcome, 32);
      if (form == "mesh.ply") {
        EXPECT_TRUE(bytes == file("out.reeb")) << last_command();
      }
    }
}

// The clusters of triangles in no order are nearly all joined, so that their matrix is dense.
TEST_F(MemoryLimit, HoldsForTheSpectralOrderOfTrianglesInNoOrder) {
  constexpr std::uint32_t kVertices = 60'000;
  {
    PlyFile ply(in_folder("mesh.ply"), kVertices, kVertices);
    for (std::uint32_t v = 0; v < kVertices; ++v) ply.vertex(value_of(v), value_of(3 * v + 1), value_of(7 * v + 2));
    const auto corner = [](std::uint32_t n) { return (n * 2654435761u >> 4) % kVertices; };
    for (std::uint32_t t = 0; t < kVertices; ++t) ply.triangle(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2));
  }
  const Outcome outcome = reeb({"convert", "mesh.ply", "out.smb", "--order", "spectral", "--memory", "32M", "--quiet"});
  expect_success(outcome);
  expect_within(outcome, 32);
}

// All triangles share an edge: beside the weight of its ends, a usual shift of the matrix is lost in rounding.
TEST_F(MemoryLimit, HoldsForTheSpectralOrderOfTrianglesAtOneEdge) {
  constexpr std::uint32_t kTriangles = 1'000'000;
  {
    PlyFile ply(in_folder("mesh.ply"), kTriangles + 2, kTriangles);
    for (std::uint32_t v = 0; v < kTriangles + 2; ++v)
      ply.vertex(value_of(v), value_of(3 * v + 1), value_of(7 * v + 2));
    for (std::uint32_t t = 0; t < kTriangles; ++t) ply.triangle(0, 1, t + 2);
  }
  const Outcome outcome = reeb({"convert", "mesh.ply", "out.smb", "--order", "spectral", "--memory", "64M", "--quiet"});
  expect_success(outcome);
  expect_within(outcome, 64);
}

// Each isolated vertex is a component without loops: the table of tops has none of them, and the graph is charged.
TEST_F(MemoryLimit, HoldsForTheRepairOfIsolatedVertices) {
  constexpr std::uint32_t kVertices = 300'000;
  {
    PlyFile ply(in_folder("mesh.ply"), kVertices, 0);
    for (std::uint32_t v = 0; v < kVertices; ++v) ply.vertex(static_cast<float>(v), 0, value_of(v));
  }
  const auto repair = [&](const std::string& memory) {
    return reeb({"repair", "mesh.ply", "-o", "o.ply", "--memory", memory, "--quiet"});
  };
  const Outcome refused = repair("32M");
  expect_error(refused, 3, "graph of the loops needs ");
  expect_within(refused, 32);
  const Outcome done = repair("64M");
  expect_success(done);
  expect_within(done, 64);
}

// The paths of the edges between all pairs of few vertices become long while chunks are glued, and edges are many.
TEST_F(MemoryLimit, HoldsForTrianglesBetweenFewVertices) {
  constexpr std::uint32_t kVertices = 1200, kTriangles = 700'000;
  {
    PlyFile ply(in_folder("mesh.ply"), kVertices, kTriangles);
    for (std::uint32_t v = 0; v < kVertices; ++v) ply.vertex(value_of(v + 7), value_of(v + 13), value_of(v));
    std::mt19937 random(1);
    for (std::uint32_t t = 0; t < kTriangles; ++t) {
      const auto corner = [&] { return static_cast<std::uint32_t>(random() % kVertices); };
      const std::uint32_t a = corner(), b = corner();
      ply.triangle(a, b, corner());
    }
  }
  for (const std::uint64_t megabytes : {64u, 96u, 128u, 192u})
    for (const char* threads : {"1", "2"})
      expect_done_or_refused(compute("mesh.ply", megabytes, threads, {}), megabytes);
}

}  // namespace
}  // namespace reeb::test
