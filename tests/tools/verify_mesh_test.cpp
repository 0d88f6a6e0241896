// `reeb verify FILE --mesh MESH`: the file against a recount of the mesh.
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

constexpr const char* kTetrahedron = "1 component, Euler characteristic 2, a closed surface of genus 0\n";

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

TEST_F(VerifyMesh, ATorusHasGenusOneForEveryFunction) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "torus.ply"}));
  for (const char* function : {"x", "z", "index", "random:3"})
    EXPECT_EQ(said_of("torus.ply", function), "1 component, Euler characteristic 0, a closed surface of genus 1\n");
}

TEST_F(VerifyMesh, AnotherMeshIsNoticed) {
  write("mesh.off", kSmallOff);
  expect_success(reeb({"compute", "mesh.off", "--quiet"}));
  const auto expect_refused = [&](const std::string& mesh) {
    write("other.off", mesh);
    const Outcome outcome = reeb({"verify", "mesh.reeb", "--mesh", "other.off"});
    EXPECT_EQ(outcome.exit_code, 1) << mesh;
    EXPECT_EQ(lines_after("reeb: error: ", outcome.error).size(), 1u) << outcome.error;
  };
  expect_refused("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");    // a value
  expect_refused("OFF\n4 4 0\n0 0.5 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");  // a position
  expect_refused("OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");             // a triangle
  expect_refused("OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 .5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  expect_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 2 1\n");
  write("broken.off", "OFF\n4 4");
  EXPECT_EQ(reeb({"verify", "mesh.reeb", "--mesh", "broken.off"}).exit_code, 1);
}

}  // namespace
}  // namespace reeb::test
