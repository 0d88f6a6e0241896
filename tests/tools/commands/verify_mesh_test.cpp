// `reeb verify FILE --mesh MESH`: the file against a recount of the mesh.
#include <optional>
#include <utility>

#include "ooc/reeb_file/reeb_file.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class VerifyMesh : public ProgramTest {
 protected:
  // What the program says about the mesh of a good file.
  std::string said_of(const std::string& mesh, const std::string& function = "z") {
    expect_success(reeb({"compute", mesh, "-f", function, "-o", "out.reeb", "--quiet", "--force"}));
    const Outcome outcome = reeb({"verify", "out.reeb", "--mesh", mesh});
    expect_success(outcome);
    const std::string begin = mesh + ": OK: ";
    std::string said = outcome.output;
    said.erase(0, said.find(begin) == std::string::npos ? 0 : said.find(begin) + begin.size());
    return said;
  }
};

constexpr const char* kTetrahedron = "1 component, Euler characteristic 2, a closed surface: at most 0 loops\n";

TEST_F(VerifyMesh, CountsWhatTheMeshIs) {
  write("closed.off", kSmallOff);
  EXPECT_EQ(said_of("closed.off"), kTetrahedron);
  // Repeated, reversed and degenerate triangles change nothing.
  write("repeated.off",
        "OFF\n4 7 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n3 2 1 0\n3 0 1 1\n3 2 2 2\n");
  EXPECT_EQ(said_of("repeated.off"), kTetrahedron);
  write("open.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 5 5\n3 0 1 2\n3 1 2 3\n");
  EXPECT_EQ(said_of("open.off"), "2 components, Euler characteristic 2, a surface with boundary: at most 0 loops\n");
  write("edge.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n2 2 3\n");
  EXPECT_EQ(said_of("edge.off"),
            "1 component, Euler characteristic 1, not a 2-manifold, so the genus is undefined and the loops are not "
            "bounded\n");
  write("book.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 2\n3 0 1 2\n3 0 1 3\n3 0 1 4\n");
  EXPECT_EQ(said_of("book.off"),
            "1 component, Euler characteristic 1, not a 2-manifold, so the genus is undefined and the loops are not "
            "bounded\n");
  write("pinched.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 2\n3 0 1 2\n3 0 3 4\n");
  EXPECT_EQ(said_of("pinched.off"),
            "1 component, Euler characteristic 1, not a 2-manifold, so the genus is undefined and the loops are not "
            "bounded\n");
}

TEST_F(VerifyMesh, ATorusHasAtMostOneLoopForEveryFunction) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "torus.ply"}));
  for (const char* function : {"x", "z", "index", "random:3"})
    EXPECT_EQ(said_of("torus.ply", function),
              "1 component, Euler characteristic 0, a closed surface: at most 1 loop\n");
}

// A grid of squares, whose sides are joined: two as those of a torus, the other two reversed.
TEST_F(VerifyMesh, AKleinBottleHasNoGenusOfAnOrientedSurface) {
  constexpr int kSize = 6;
  std::string text = "OFF\n" + std::to_string(kSize * kSize) + " " + std::to_string(2 * kSize * kSize) + " 0\n";
  const auto number = [](int i, int j) {
    return std::to_string(i % kSize * kSize + (i < kSize ? j : 2 * kSize - j) % kSize);
  };
  for (int i = 0; i < kSize; ++i)
    for (int j = 0; j < kSize; ++j)
      text += std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(i * j % 5) + "\n";
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) {
      const std::string corner = number(i, j), opposite = number(i + 1, j + 1);
      text += "3 " + corner + " " + number(i + 1, j) + " " + opposite + "\n";
      text += "3 " + corner + " " + opposite + " " + number(i, j + 1) + "\n";
    }
  }
  write("klein.off", text);
  EXPECT_EQ(said_of("klein.off"), "1 component, Euler characteristic 0, a closed surface: at most 1 loop\n");
  const Outcome info = reeb({"info", "klein.off"});
  expect_success(info);
  EXPECT_NE(info.output.find("it is not orientable"), std::string::npos) << info.output;
}

TEST_F(VerifyMesh, AnotherMeshIsNoticed) {
  write("mesh.off", kSmallOff);
  expect_success(reeb({"compute", "mesh.off", "--quiet"}));
  const auto expect_refused = [&](const std::string& mesh, const std::string& error = {}) {
    write("other.off", mesh);
    const Outcome outcome = reeb({"verify", "mesh.reeb", "--mesh", "other.off"});
    EXPECT_EQ(outcome.exit_code, 1) << mesh;
    const auto errors = lines_after("reeb: error: ", outcome.error);
    ASSERT_EQ(errors.size(), 1u) << outcome.error;
    EXPECT_TRUE(errors[0].starts_with(error)) << errors[0];
  };
  expect_refused("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");    // a value
  expect_refused("OFF\n4 4 0\n0 0.5 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");  // a position
  expect_refused("OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");             // a triangle
  expect_refused("OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 .5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  expect_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 2 1\n");
  // Counts tell more than the first node that differs.
  expect_refused("OFF\n5 1 0\n1 0 0\n1 0 2\n0 1 0\n0 0 1\n2 2 2\n3 0 2 1\n",
                 "mesh.reeb: this is not the graph of that mesh: it was computed from 4 vertices, the mesh has 5");
  write("broken.off", "OFF\n4 4");
  EXPECT_EQ(reeb({"verify", "mesh.reeb", "--mesh", "broken.off"}).exit_code, 1);
}

TEST_F(VerifyMesh, AFunctionThatIsNoneIsAnError) {
  write("mesh.off", kSmallOff);
  ReebGraph graph;
  graph.nodes = {{0, VertexId(0)}, {1, VertexId(3)}};
  graph.lo = {NodeId(0)};
  graph.hi = {NodeId(1)};
  ooc::FileMeta meta;
  meta.function = "q";
  meta.function_max = 1;
  meta.mesh_vertices = 4;
  meta.mesh_triangles = 4;
  ooc::write_graph_file(in_folder("q.reeb"), meta, graph);
  expect_success(reeb({"verify", "q.reeb"}));
  const Outcome outcome = reeb({"verify", "q.reeb", "--mesh", "mesh.off"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.error.find("\"q\" is not a function"), std::string::npos) << outcome.error;
  meta.function = "x";
  ooc::write_graph_file(in_folder("x.reeb"), meta, graph);
  EXPECT_EQ(reeb({"verify", "x.reeb", "--mesh", "mesh.off"}).exit_code, 1);
  meta.function = "z";
  ooc::write_graph_file(in_folder("z.reeb"), meta, graph);
  expect_success(reeb({"verify", "z.reeb", "--mesh", "mesh.off", "--full"}));
}

TEST_F(VerifyMesh, AFileOfValuesThatIsGoneIsSaid) {
  write("mesh.off", kSmallOff);
  write("values.txt", "0\n1\n2\n3\n");
  expect_success(reeb({"compute", "mesh.off", "-f", "file:values.txt", "--quiet"}));
  const Outcome with = reeb({"verify", "mesh.reeb", "--mesh", "mesh.off", "--full"});
  expect_success(with);
  EXPECT_EQ(with.output.find("note"), std::string::npos) << with.output;
  write("values.txt", "0\n1\n2\n4\n");
  EXPECT_EQ(reeb({"verify", "mesh.reeb", "--mesh", "mesh.off"}).exit_code, 1);
  std::filesystem::remove(in_folder("values.txt"));
  const Outcome full = reeb({"verify", "mesh.reeb", "--mesh", "mesh.off", "--full"});
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_TRUE(full.error.starts_with("reeb: error: values.txt: there is no such file, and --full needs")) << full.error;
  const Outcome without = reeb({"verify", "mesh.reeb", "--mesh", "mesh.off"});
  expect_success(without);
  EXPECT_NE(without.output.find("values.txt is gone, so the values were not checked"), std::string::npos)
      << without.output;
}

// The graph with the upper ends of two arcs exchanged, or nothing if no two can be.
std::optional<ReebGraph> with_exchanged_ends(ReebGraph graph) {
  for (std::size_t a = 0; a < graph.arc_count(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (graph.lo[a] != graph.lo[b] && graph.hi[a] != graph.hi[b] && graph.lo[a] < graph.hi[b] &&
          graph.lo[b] < graph.hi[a]) {
        std::swap(graph.hi[a], graph.hi[b]);
        return graph;
      }
  return std::nullopt;
}

TEST_F(VerifyMesh, AForgedGraphIsFoundWhenItIsComputedAgain) {
  expect_success(reeb({"generate", "scan", "--triangles", "20000", "-o", "scan.ply"}));
  expect_success(reeb({"compute", "scan.ply", "--graph-only", "-o", "true.reeb", "--buckets", "0", "--quiet"}));
  const ooc::ReebFile file(in_folder("true.reeb"));
  const std::optional<ReebGraph> forged = with_exchanged_ends(file.load(0).graph);
  ASSERT_TRUE(forged.has_value());
  ooc::FileMeta meta;
  meta.function = file.header().function;
  meta.function_min = file.header().function_min;
  meta.function_max = file.header().function_max;
  meta.mesh_vertices = file.header().mesh_vertices;
  meta.mesh_triangles = file.header().mesh_triangles;
  ooc::write_graph_file(in_folder("forged.reeb"), meta, *forged);
  expect_success(reeb({"verify", "true.reeb", "--mesh", "scan.ply", "--full"}));
  const Outcome outcome = reeb({"verify", "forged.reeb", "--mesh", "scan.ply", "--full"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.error.find("in the graph of the mesh"), std::string::npos) << outcome.error;
}

TEST_F(VerifyMesh, WhatWasComputedWithAnyOptionsIsTheSameAgain) {
  expect_success(reeb({"generate", "scan", "--triangles", "20000", "-o", "scan.ply"}));
  for (const char* option : {"--denoise=0.5%", "--denoise=0.03", "--graph-only", "--buckets=7", "--chunk=500"}) {
    expect_success(reeb({"compute", "scan.ply", option, "-o", "out.reeb", "--force", "--quiet", "-f", "x"}));
    const Outcome outcome = reeb({"verify", "out.reeb", "--mesh", "scan.ply", "--full", "--memory", "64M"});
    expect_success(outcome);
    EXPECT_NE(outcome.output.find("computed again"), std::string::npos) << option;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"out.reeb", "scan.ply"}));
  expect_error(reeb({"verify", "out.reeb", "--full"}), 2, "--full needs a mesh");
}

}  // namespace
}  // namespace reeb::test
