// `reeb function`, and the functions that read the mesh before the run.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

// A strip of unit squares along x, each divided; vertex 2 i + j is (i, j, 0).
std::string strip(int squares, const std::string& more_vertices = {}, int more = 0) {
  std::ostringstream off;
  off << "OFF\n" << 2 * squares + 2 + more << ' ' << 2 * squares << " 0\n";
  for (int i = 0; i <= squares; ++i) off << i << " 0 0\n" << i << " 1 0\n";
  off << more_vertices;
  for (int i = 0; i < squares; ++i) {
    const int a = 2 * i;
    off << "3 " << a << ' ' << a + 1 << ' ' << a + 2 << "\n3 " << a + 1 << ' ' << a + 3 << ' ' << a + 2 << '\n';
  }
  return off.str();
}

class Function : public ProgramTest {
 protected:
  std::vector<double> values(const std::string& mesh, const std::string& function) {
    expect_success(reeb({"function", mesh, "-f", function, "-o", "v.txt", "--force", "--quiet"}));
    expect_success(reeb({"function", mesh, "-f", function, "-o", "v.f64", "--force", "--quiet"}));
    std::istringstream text(file("v.txt"));
    std::vector<double> result;
    for (double value = 0; text >> value;) result.push_back(value);
    const std::string raw = file("v.f64");
    EXPECT_EQ(raw.size(), 8 * result.size());
    EXPECT_EQ(std::memcmp(raw.data(), result.data(), std::min(raw.size(), 8 * result.size())), 0) << function;
    expect_success(reeb({"function", mesh, "-f", function, "-o", "v.npy", "--force", "--quiet"}));
    std::string dictionary =
        "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(result.size()) + ",), }";
    dictionary.resize(117, ' ');
    EXPECT_EQ(file("v.npy"), "\x93NUMPY\x01" + std::string("\0\x76\0", 3) + dictionary + "\n" + raw) << function;
    return result;
  }
};

TEST_F(Function, WritesNumbersInTheirShortestForm) {
  write("short.obj", "v 0 0 0.1\nv 1 0 -1e-7\nv 0 1 2\nf 1 2 3\n");
  expect_success(reeb({"function", "short.obj", "-f", "z", "-o", "short.txt"}));
  EXPECT_EQ(file("short.txt"), "0.1\n-1e-07\n2\n");
}

TEST_F(Function, WritesValuesInTheOrderOfVertices) {
  write("s.off", strip(3));
  EXPECT_EQ(values("s.off", "x"), (std::vector<double>{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(values("s.off", "index"), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(values("s.off", "distance:3,0,0")[7], 1);
  EXPECT_EQ(values("s.off", "distance:6"), values("s.off", "distance:3,0,0"));
  const auto far = values("s.off", "geodesic:0");
  for (std::size_t v = 0; v < far.size(); ++v)
    EXPECT_NEAR(far[v], std::hypot(static_cast<double>(v / 2), static_cast<double>(v % 2)), 1e-12) << v;
  EXPECT_EQ(values("s.off", "geodesic:0,6")[7], 1);
}

// Scans have NaN in confidences and normals.
TEST_F(Function, PropertiesThatAreNotUsedNeedNotBeFinite) {
  write("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float q\nproperty float p\nelement face 2\nproperty list uchar int vertex_index\n"
        "end_header\n"
        "0 0 0 nan 1\n1 0 1 inf 2\n0 1 2 5 3\n1 1 3 6 4\n3 0 1 2\n3 2 1 3\n");
  const std::string note = "2 values of properties that are not used are not finite";
  const Outcome converted = reeb({"convert", "a.ply", "b.ply"});
  expect_success(converted);
  EXPECT_EQ(lines_after("note: ", converted.error), std::vector<std::string>{note});
  expect_success(reeb({"compute", "a.ply", "-o", "g.reeb", "--quiet"}));
  const std::vector<std::vector<std::string>> commands = {{"convert", "MESH", "o.ply"},
                                                          {"convert", "MESH", "o.ply", "--order", "hilbert"},
                                                          {"convert", "MESH", "o.ply", "--order", "sweep:property:p"},
                                                          {"repair", "MESH", "-o", "o.ply", "--drop-duplicates"},
                                                          {"function", "MESH", "-f", "z", "-o", "o.ply"},
                                                          {"segment", "MESH", "g.reeb", "-o", "o.ply"}};
  for (const std::string mesh : {"a.ply", "b.ply"})
    for (std::vector<std::string> words : commands) {
      words[1] = mesh;
      words.push_back("--force");
      const Outcome outcome = reeb(words);
      SCOPED_TRACE(last_command() + '\n' + outcome.error);
      expect_success(outcome);
      EXPECT_EQ(lines_after("note: ", outcome.error), std::vector<std::string>{note});
      auto kept = values("o.ply", "property:p");
      std::ranges::sort(kept);
      EXPECT_EQ(kept, (std::vector<double>{1, 2, 3, 4}));
      EXPECT_EQ(reeb({"function", "o.ply", "-f", "property:q", "-o", "q.ply", "--force"}).exit_code, 1);
    }
  EXPECT_EQ(reeb({"convert", "b.ply", "o.ply", "--order", "sweep:property:q", "--force"}).exit_code, 1);
}

TEST_F(Function, APropertyOfThePlyGivesTheSameGraph) {
  write("s.off", strip(40));
  for (const std::string function : {"geodesic:3", "laplacian:1", "spectral", "distance:3", "random:7"}) {
    SCOPED_TRACE(function);
    expect_success(reeb({"function", "s.off", "-f", function, "-o", "p.ply", "--force", "--quiet"}));
    expect_success(reeb({"function", "s.off", "-f", function, "-o", "p.f64", "--force", "--quiet"}));
    expect_success(reeb({"function", "s.off", "-f", function, "-o", "p.npy", "--force", "--quiet"}));
    for (const auto& [mesh, name, out] : {std::tuple{std::string("s.off"), function, "a.reeb"},
                                          {"p.ply", "property:" + function, "b.reeb"},
                                          {"s.off", "file:p.f64", "c.reeb"},
                                          {"s.off", "file:p.npy", "d.reeb"}})
      expect_success(reeb({"compute", mesh, "-f", name, "-o", out, "--quiet", "--force"}));
    for (const char* out : {"a.reeb", "b.reeb", "c.reeb", "d.reeb"})
      expect_success(reeb({"pairs", out, "-o", std::string(out) + ".csv", "--force"}));
    EXPECT_EQ(file("a.reeb.csv"), file("b.reeb.csv"));
    EXPECT_EQ(file("a.reeb.csv"), file("c.reeb.csv"));
    EXPECT_EQ(file("a.reeb.csv"), file("d.reeb.csv"));
    expect_success(reeb({"verify", "a.reeb", "--mesh", "s.off"}));
  }
}

TEST_F(Function, OfAnImageAsAPropertyOfItsDivision) {
  expect_success(reeb({"generate", "volume", "--grid", "6x5x4", "-o", "v.nrrd"}));
  expect_success(reeb({"function", "v.nrrd", "-o", "value.ply", "--quiet"}));
  expect_success(reeb({"function", "v.nrrd", "-f", "y", "-o", "y.ply", "--quiet"}));
  for (const auto& [mesh, name, out] : {std::tuple{"v.nrrd", "value", "a.csv"},
                                        {"value.ply", "property:value", "b.csv"},
                                        {"v.nrrd", "y", "c.csv"},
                                        {"y.ply", "y", "d.csv"}}) {
    expect_success(reeb({"compute", mesh, "-f", name, "-o", "o.reeb", "--quiet", "--force"}));
    expect_success(reeb({"pairs", "o.reeb", "-o", out}));
  }
  EXPECT_EQ(file("a.csv"), file("b.csv"));
  EXPECT_EQ(file("c.csv"), file("d.csv"));
}

TEST_F(Function, APipeCannotLookUpAVertex) {
  write("s.off", strip(3));
  ASSERT_EQ(::mkfifo(in_folder("pipe").c_str(), 0600), 0);
  const pid_t writer = ::fork();
  if (writer == 0) {
    std::ofstream(in_folder("pipe")) << strip(3);
    ::_exit(0);
  }
  expect_error(reeb({"function", "pipe", "-f", "distance:3", "-o", "o.txt"}), 1,
               "pipe: distance:3 needs a vertex first");
  ::waitpid(writer, nullptr, 0);
}

TEST_F(Function, TheLaplacianOfAStripChangesSignAlongIt) {
  write("s.off", strip(30));
  const auto first = values("s.off", "laplacian:1"), second = values("s.off", "laplacian:2");
  int changes = 0, more = 0;
  for (std::size_t v = 2; v < first.size(); v += 2) {
    changes += (first[v] > 0) != (first[v - 2] > 0);
    more += (second[v] > 0) != (second[v - 2] > 0);
  }
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(more, 2);
}

TEST_F(Function, BadOnesAreToldApart) {
  write("s.off", strip(3));
  write("far.off", strip(3, "9 9 9\n", 1));
  write("flat.off", "nOFF 2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2\n");
  const auto run = [this](const std::string& mesh, const std::string& function) {
    return reeb({"compute", mesh, "-f", function, "-o", "o.reeb", "--quiet"});
  };
  expect_error(run("s.off", "distance:8"), 1,
               "s.off: distance:8 names a vertex that does not exist: the mesh has 8 vertices");
  expect_error(run("s.off", "geodesic:2,99"), 1, "s.off: geodesic:2,99 names vertex 99");
  expect_error(run("s.off", "laplacian:8"), 1, "s.off: the largest component has 8 vertices");
  expect_error(run("far.off", "geodesic:0"), 1, "far.off: geodesic:0 does not reach vertex 8");
  write("huge.off", "OFF\n3 1 0\n-1.7e308 0 0\n1.7e308 0 0\n0 1.7e308 1.7e308\n3 0 1 2\n");
  EXPECT_EQ(run("huge.off", "geodesic:0").exit_code, 1) << "a distance is beyond the doubles";
  expect_error(run("flat.off", "distance:1,2,3"), 1, "flat.off: distance:1,2,3 is a point with three coordinates");
  for (const char* function : {"distance:", "distance:1,2", "distance:-1", "distance:1,2,x", "distance:1,2,3,4",
                               "geodesic:", "geodesic:1,", "geodesic:x", "laplacian:", "laplacian:x", "laplacian:-1"})
    expect_error(run("s.off", function), 2, std::string("\"") + function + "\" is not a function");
  const std::pair<const char*, const char*> meant[] = {
      {"X", "x"},        {"hight", "z"}, {"height", "z"}, {"geodesc:1", "geodesic:1"}, {"laplacien", "laplacian:1"},
      {"Index", "index"}};
  for (const auto& [function, name] : meant)
    expect_error(run("s.off", function), 2,
                 std::string("\"") + function + "\" is not a function (did you mean " + name + "?)");
  for (const char* function : {"q", "c", "quux", "distance:1,2"})
    EXPECT_EQ(run("s.off", function).error.find("did you mean"), std::string::npos) << function;
  EXPECT_EQ(lines_after("hint: ", run("s.off", "x,y").error),
            std::vector<std::string>{"for several functions repeat -f: -f x -f y"});
  EXPECT_EQ(lines_after("hint: value is the function of an image; s.off is a mesh", run("s.off", "value").error).size(),
            1u);
  expect_error(reeb({"function", "s.off", "-f", "x", "-f", "y", "-o", "o.f64"}), 2,
               "reeb function takes one function; -f was given twice");
  expect_error(run("s.off", "geodesic"), 2, "geodesic needs a vertex");
  EXPECT_NE(run("s.off", "geodesic").error.find("hint: for instance geodesic:0\n"), std::string::npos);
  expect_error(run("s.off", "file"), 2, "file needs a path");
  expect_error(run("s.off", "laplacian:0"), 2, "\"laplacian:0\" is not a function: K of laplacian:K is at least 1");
  expect_error(
      reeb({"compute", "-", "-f", "geodesic:0", "-o", "o.reeb"}, {.arguments = {}, .input = in_folder("s.off")}), 1,
      "standard input: geodesic:0 reads the mesh before the run does");
  expect_error(reeb({"function", "s.off", "-f", "x", "-o", "o.csv"}), 2, "values are not written as \".csv\"");
  expect_error(reeb({"function", "s.off", "-f", "x", "-o", "s.off"}), 2);
  EXPECT_EQ(files(), (std::vector<std::string>{"far.off", "flat.off", "huge.off", "s.off"}));
}

TEST_F(Function, OtherComponentsAreCountedOnce) {
  write("far.off", strip(3, "9 9 9\n", 1));
  const Outcome outcome = reeb({"function", "far.off", "-f", "spectral", "-o", "o.txt"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("note: spectral is 0 at 1 vertex outside the largest component"), std::string::npos)
      << outcome.error;
}

}  // namespace
}  // namespace reeb::test
