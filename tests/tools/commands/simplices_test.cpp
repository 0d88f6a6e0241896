// Simplices of any dimension through the whole program: CX files, counts, other numbers of coordinates, distances.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using nlohmann::json;

class Simplices : public ProgramTest {
 protected:
  json report_of(std::vector<std::string> words, Command command = {}) {
    words.insert(words.begin(), "compute");
    words.insert(words.end(), {"-o", "out.reeb", "--force", "--quiet", "--report", "-"});
    const Outcome outcome = reeb(words, std::move(command));
    expect_success(outcome);
    return outcome.exit_code == 0 ? json::parse(outcome.output) : json();
  }
  json info_of(const std::vector<std::string>& words) {
    std::vector<std::string> all = {"info", "--json"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = reeb(all);
    expect_success(outcome);
    return json::parse(outcome.output);
  }
};

std::uint64_t power(std::uint64_t base, unsigned exponent) {
  std::uint64_t result = 1;
  for (; exponent > 0; --exponent) result *= base;
  return result;
}

// Every pair of corners of a simplex spans an edge whose midpoint joins two of its children, so each divided simplex
// adds C(D, 2) loops, whatever the function is.
TEST_F(Simplices, ASierpinskiSimplexHasItsLoopsForEveryCoordinate) {
  for (unsigned dimension = 2; dimension <= 5; ++dimension)
    for (unsigned level = 0; level <= 4; ++level) {
      const std::uint64_t cells = power(dimension + 1, level);
      const std::uint64_t triangles = cells * (dimension + 1) * dimension * (dimension - 1) / 6;
      const std::uint64_t loops = std::uint64_t{dimension} * (dimension - 1) / 2 * (cells - 1) / dimension;
      expect_success(reeb({"generate", "sierpinski", "--dimension", std::to_string(dimension), "--triangles",
                           std::to_string(triangles), "-o", "s.cx", "--force"}));
      std::vector<std::string> words = {"s.cx", "-f", "random:1"};
      for (unsigned k = 0; k < dimension; ++k)
        words.insert(words.end(), {"-f", std::string("c").append(std::to_string(k))});
      const json reports = report_of(words);
      ASSERT_EQ(reports.size(), dimension + 1);
      for (const json& report : reports) {
        EXPECT_EQ(report["graph"]["loops"], loops) << dimension << ", level " << level << ", " << report["function"];
        EXPECT_EQ(report["graph"]["components"], 1);
        EXPECT_EQ(report["input"]["simplices"][dimension], cells);
        EXPECT_EQ(report["input"]["triangles"], dimension == 2 ? cells : 0);
      }
    }
}

// A circle of edges and an edge. After its loop is cancelled, the circle still has two nodes, which are one arc then.
TEST_F(Simplices, TheFinestOfLevelsWithAsManyNodesIsTaken) {
  write("circle.cx", "v 0 0 0\nv 1 0 1\nv 2 0 3\nv 0 1 4\nv 5 0 0\nv 5 1 9\ns 0 1\ns 1 3\ns 0 2\ns 2 3\ns 4 5\n");
  expect_success(reeb({"circle.cx", "-o", "circle.reeb"}));
  const auto arcs = [this](const std::vector<std::string>& level) {
    std::vector<std::string> words = {"extract", "circle.reeb", "--format", "rg"};
    words.insert(words.end(), level.begin(), level.end());
    return lines_after("a ", reeb(words).output).size();
  };
  EXPECT_EQ(arcs({}), 3u);
  EXPECT_EQ(arcs({"--threshold", "5"}), 2u);
  for (const char* nodes : {"4", "5"}) EXPECT_EQ(arcs({"--nodes", nodes}), 3u) << nodes;
}

TEST_F(Simplices, AManifoldHasTheSameGraphAndNoThirdTriangle) {
  expect_success(reeb({"generate", "scan", "--triangles", "20k", "--order", "random", "-o", "scan.ply"}));
  std::vector<std::string> words = {"compute", "scan.ply", "--buckets", "0", "--quiet", "--force", "--chunk", "500"};
  std::vector<std::string> bytes;
  for (const bool manifold : {false, true}) {
    if (manifold) words.emplace_back("--manifold");
    expect_success(reeb(words));
    bytes.push_back(file("scan.reeb"));
  }
  EXPECT_TRUE(bytes[0] == bytes[1]);

  write("fan.off", "OFF\n5 3 0\n0 0 0\n0 0 1\n1 0 0\n0 1 0\n1 1 1\n3 0 1 2\n3 3 1 0\n3 4 0 1\n");
  const Outcome third = reeb({"compute", "fan.off", "--manifold"});
  EXPECT_EQ(third.exit_code, 1);
  EXPECT_NE(third.error.find("reeb: error: fan.off: the edge between vertices 0 and 1 has a third triangle\nhint: "),
            std::string::npos)
      << third.error;
  EXPECT_EQ(std::filesystem::exists(in_folder("fan.reeb")), false);

  // The diagonals of squares are in two triangles, those of cubes in more.
  expect_success(reeb({"generate", "volume", "--grid", "9x9x9", "-o", "cube.nrrd"}));
  EXPECT_EQ(reeb({"compute", "cube.nrrd", "--manifold", "--quiet"}).exit_code, 1);
  write("plane.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 5 2\n0 3 4\n");
  expect_success(reeb({"compute", "plane.asc", "--manifold", "--quiet"}));
}

// The construction has N tunnels, each through all levels of its layer of z.
TEST_F(Simplices, ABallHasALoopForEachHandle) {
  for (const std::string name : {"b.sva", "b.svb", "b.cx"}) {
    const Outcome made = reeb({"generate", "ball", "--tetrahedra", "3k", "--handles", "7", "--seed", "2", "-o", name});
    expect_success(made);
    EXPECT_NE(made.error.find("Euler characteristic -6, first"), std::string::npos) << made.error;
    const json reports = report_of({name, "-f", "z", "-f", "x", "-f", "random:1"});
    EXPECT_EQ(reports[0]["graph"]["loops"], 7) << name;
    for (const json& report : reports) {
      EXPECT_EQ(report["graph"]["components"], 1);
      EXPECT_LE(report["graph"]["loops"], 7);
      EXPECT_EQ(report["input"]["simplices"], info_of({name})["simplices"]);
      EXPECT_EQ(report["input"]["triangles"], 0);
    }
    EXPECT_NEAR(reports[0]["input"]["simplices"][3].get<double>(), 3000, 300);
  }
  for (const std::string name : {"b.ply", "b.obj", "b.off", "b.sma", "b.smb", "b.smc"})
    expect_error(reeb({"generate", "ball", "-o", name}), 2, name + ": a ball consists of tetrahedra");
  expect_error(reeb({"generate", "ball", "--triangles", "9", "-o", "c.sva"}), 2, "a ball has no --triangles");
  expect_error(reeb({"generate", "torus", "--tetrahedra", "9", "-o", "c.ply"}), 2, "a torus has no --tetrahedra");
  expect_error(reeb({"generate", "torus", "--handles", "9", "-o", "c.ply"}), 2, "a torus has no --handles");
  expect_error(reeb({"generate", "ball", "--order", "tiles:4", "-o", "c.sva"}), 2, "a ball has no tiles");
}

TEST_F(Simplices, MessagesOfAVolumeAreTrue) {
  write("t.cx", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ns 0 1 2 3\n");
  const Outcome computed = reeb({"t.cx"});
  expect_success(computed);
  EXPECT_EQ(computed.error.find("genus"), std::string::npos) << computed.error;
  EXPECT_NE(reeb({"info", "t.reeb"}).output.find("4 vertices, no triangles; the file has no count of"),
            std::string::npos);
  const Outcome verified = reeb({"verify", "t.reeb", "--mesh", "t.cx"});
  EXPECT_NE(verified.output.find("Euler characteristic of the 2-skeleton 2"), std::string::npos) << verified.output;
}

// Nothing is complete before the end of such a stream, so it is read by way of a copy on disk. In its own order, the
// live graph of this one does not fit.
TEST_F(Simplices, AStreamWithoutFinalizationTakesLittleMemory) {
  expect_success(reeb({"generate", "ball", "--tetrahedra", "100k", "-o", "b.svb"}));
  expect_success(reeb({"generate", "ball", "--tetrahedra", "100k", "-o", "b.cx"}));
  const auto graph_of = [this](const std::string& name) {
    expect_success(reeb({"compute", name, "--graph-only", "--memory", "48M", "--force"}));
    const Outcome graph = reeb({"extract", "b.reeb", "--format", "rg"});
    expect_success(graph);
    return graph.output;
  };
  EXPECT_EQ(graph_of("b.svb"), graph_of("b.cx"));
}

TEST_F(Simplices, AreCountedByDimensionHoweverTheyAreRead) {
  const std::string mixed =
      "# a comment\nv 0 0 0\nv 1 0 0 # c\nv 0 1 0\nv 0 0 1\nv 5 5 5\n\ns 0 1 2 3\ns 4\ns 0 4\ns 1 4\ns 0 1 1\n";
  const json expected = {1, 2, 1, 1, 0, 0, 0, 0, 0};
  write("m.cx", mixed);
  EXPECT_EQ(info_of({"m.cx"})["simplices"], expected);
  EXPECT_EQ(info_of({"m.cx"})["components"]["count"], 1);
  EXPECT_TRUE(info_of({"m.cx"})["degenerate"].is_null());
  EXPECT_EQ(info_of({"m.cx"})["genus_why"], "it is not a surface: it has cells");
  const json graph = report_of({"m.cx"})["graph"];
  EXPECT_EQ(graph["components"], 1);
  EXPECT_EQ(graph["loops"], 1);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--chunk", "1"}, {"-f", "x"}, {"-f", "distance:4"}}) {
    std::vector<std::string> words = {"m.cx"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(report_of(words)["input"]["simplices"], expected);
    EXPECT_EQ(report_of(words)["input"]["triangles"], 1);
  }
  write("pipe", mixed);
  Command from_pipe;
  from_pipe.input = in_folder("pipe");
  EXPECT_EQ(report_of({"-", "--format", "cx"}, from_pipe)["input"]["simplices"], expected);
  // Edges and points are faces of PLY and OFF; what is read back is the same, but for the cell.
  for (const std::string name : {"m.ply", "m.off", "m.obj"}) {
    expect_success(reeb({"convert", "m.cx", name}));
    const json report = report_of({name});
    EXPECT_EQ(report["input"]["simplices"], json({1, 2, 5, 0, 0, 0, 0, 0, 0})) << name;
    EXPECT_EQ(report["graph"], graph) << name;
    EXPECT_EQ(report_of({name, "--sidecar"})["input"]["simplices"], report["input"]["simplices"]) << name;
    EXPECT_EQ(report_of({name})["input"]["simplices"], report["input"]["simplices"]) << "with the sidecar, " << name;
  }
  expect_success(reeb({"convert", "m.cx", "n.cx"}));
  EXPECT_EQ(info_of({"n.cx"})["simplices"], expected);
  EXPECT_EQ(report_of({"n.cx"})["graph"], graph);
}

TEST_F(Simplices, AnyNumberOfCoordinatesGoesThroughTheProgram) {
  write("one.cx", "v 1\nv 2\nv 0\ns 0 1\ns 1 2\n");
  write("two.cx", "v 0 0\nv 1 2\nv 3 1\nv 1 1\ns 0 1 2\ns 3\n");
  write("nine.cx", "v 0 0 0 0 0 0 0 0 1\nv 1 1 1 1 1 1 1 1 0\nv 2 0 0 0 0 0 0 0 0\ns 0 1\ns 1 2 0\n");
  for (const auto& [name, function] :
       {std::pair<std::string, std::string>{"one.cx", "x"}, {"two.cx", "y"}, {"nine.cx", "z"}}) {
    EXPECT_EQ(report_of({name})["function"]["name"], function);
    const Outcome verified = reeb({"verify", "out.reeb", "--mesh", name, "--full"});
    expect_success(verified);
    for (const std::string target : {"g.json", "g.vtp", "g.ply", "g.obj", "g.csv"})
      expect_success(reeb({"extract", "out.reeb", "-o", target, "--force"}));
    const json graph = json::parse(file("g.json"));
    for (const json& node : graph["nodes"]) EXPECT_EQ(node["position"].size(), 3u);
    expect_success(reeb({"info", name}));
  }
  const json two = [&] {
    report_of({"two.cx"});
    expect_success(reeb({"extract", "out.reeb", "-o", "two.json"}));
    return json::parse(file("two.json"));
  }();
  EXPECT_EQ(two["nodes"].back()["position"], json({1.0, 2.0, 0.0}));
  expect_error(reeb({"compute", "two.cx", "-f", "z", "-o", "no.reeb"}), 1, "two.cx: the mesh has no coordinate z");
}

TEST_F(Simplices, FormatsAreChosenByName) {
  write("a", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
  EXPECT_EQ(info_of({"a", "--format", "obj"})["triangles"], 1);
  write("b", kSmallOff);
  for (const std::string word : {"compute", "info"}) expect_error(reeb({word, "b", "--format", "ply"}), 1, "b:1:1: ");
  expect_error(reeb({"info", "a", "--format", "tga"}), 2, "'tga' is not a format of meshes");
  expect_success(reeb({"convert", "a", "a.ply"}));
  for (const std::string format : {"obj", "off", "sma", "vtk"})
    expect_error(reeb({"convert", "a.ply", "no.obj", "--format", format}), 1,
                 "a.ply: its content is PLY, but --format says " + format);
  expect_success(reeb({"convert", "a.ply", "again.off", "--format", "ply"}));
  expect_error(reeb({"convert", "b", "no.obj", "--format", "obj"}), 1, "b:1:1: none of its lines is OBJ");
  expect_success(reeb({"convert", "a", "a.off", "--format", "obj"}));
  report_of({"a", "--format", "obj"});
  expect_success(reeb({"verify", "out.reeb", "--mesh", "a", "--format", "obj", "--full"}));
}

TEST_F(Simplices, ADistanceIsThatOfAllCoordinates) {
  write("m.cx", "v 0 0 0 0\nv 3 0 4 0\nv 1 1 1 1\nv 0 2 0 0\ns 0 1 2 3\n");
  const json report = report_of({"m.cx", "-f", "distance:0", "-f", "distance:2", "-f", "x"});
  EXPECT_EQ(report[0]["function"]["max"], 5.0);
  EXPECT_EQ(report[0]["function"]["min"], 0.0);
  EXPECT_EQ(report[1]["function"]["max"], std::sqrt(15.0));
  EXPECT_EQ(report[2]["function"]["max"], 3.0);
  // The same for every form of input: an indexed mesh, a stream, a pipe, a mesh that is spooled.
  expect_success(reeb({"generate", "scan", "--triangles", "5000", "-o", "s.ply"}));
  expect_success(reeb({"convert", "s.ply", "s.obj"}));
  const json of_ply = report_of({"s.ply", "-f", "distance:7"});
  EXPECT_EQ(report_of({"s.obj", "-f", "distance:7"})["graph"], of_ply["graph"]);
  Command from_pipe;
  from_pipe.input = in_folder("s.obj");
  EXPECT_EQ(report_of({"-", "-f", "distance:7"}, from_pipe)["graph"], of_ply["graph"]);
  expect_success(reeb({"verify", "out.reeb", "--mesh", "s.ply", "--full"}));
  write("t.sma", "v 0 0 0\nv 3 0 4\nv 0 1 0\nf 1 2 3\nx 1\nx 2\nx 3\n");
  EXPECT_EQ(report_of({"t.sma", "-f", "distance:0"})["function"]["max"], 5.0);
  EXPECT_EQ(report_of({"t.sma", "-f", "distance:0,0,0"})["function"]["max"], 5.0);
}

TEST_F(Simplices, WrongDistancesAreRefused) {
  write("m.cx", "v 0 0\nv 1 1\ns 0 1\n");
  expect_error(reeb({"compute", "m.cx", "-f", "distance:2"}), 1, "m.cx: distance:2 names a vertex that does not exist");
  expect_error(reeb({"compute", "m.cx", "-f", "distance:0,0,0"}), 1, "m.cx: distance:0,0,0 is a point with three");
  for (const std::string text : {"distance", "distance:", "distance:1,2", "distance:1,2,3,4", "distance:a",
                                 "distance:-1", "distance:1,2,nan", "distance:1,,2", "distance:1.5"})
    expect_error(reeb({"compute", "m.cx", "-f", text}), 2);
  expect_error(reeb({"compute", "m.cx", "-f", "distance:0", "--snapshot-every", "1"}), 2);
}

TEST_F(Simplices, DamagedCxFilesNameTheirPlace) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"s 0\n", "1:1: a simplex comes before all vertices"},
      {"x 0\n", "1:1: the first item is not a vertex"},
      {"v 0 0\nv 1\n", "2:3: a vertex of 1 coordinate, but the first has 2"},
      {"v 0 0\nv 1 1 1\n", "2:7: a vertex of 3 coordinates"},
      {"v 1 2 3 4 5 6 7 8 9 10\n", "1:21: a vertex of more than 9"},
      {"v\n", "1:2: "},
      {"v 0 nan\n", "1:5: "},
      {"v 0\ns 0 1\n", "2:5: a simplex names vertex 1, but only 1 vertex came before it"},
      {"v 0\ns\n", "2:2: a vertex index should be here"},
      {"v 0\ns 0x\n", "2:3: a vertex index should be here"},
      {"v 0\ns -1\n", "2:3: a vertex index should be here"},
      {"v 0\ns 0 0 0 0 0 0 0 0 0 0\n", "2:21: a simplex of more than 9 vertices"},
      {"v 0\nf 0\n", "2:1: a line begins with neither v nor s"},
  };
  for (const auto& [text, error] : cases) {
    write("bad.cx", text);
    expect_error(reeb({"info", "bad.cx"}), 1, "bad.cx:" + error);
  }
  write("empty.cx", "# nothing\n");
  EXPECT_EQ(info_of({"empty.cx"})["vertices"], 0);
}

TEST_F(Simplices, AFormatThatCannotHoldAnEdgeIsNamedWithOneThatCan) {
  write("edge.cx", "v 0 0 0\nv 0 0 1\ns 0 1\n");
  for (const std::string out : {"edge.sma", "edge.smb"}) {
    expect_success(reeb({"convert", "edge.cx", out}));
    EXPECT_EQ(report_of({out, "-f", "z"})["graph"]["arcs"], 1) << out;
  }
  const Outcome smc = reeb({"convert", "edge.cx", "edge.smc"});
  expect_error(smc, 1, "edge.smc: SMC cannot hold a triangle with a repeated corner");
  EXPECT_NE(smc.error.find("hint: write SMA or SMB"), std::string::npos) << smc.error;
  for (const std::string out : {"edge.sva", "edge.svb"})
    expect_error(reeb({"convert", "edge.cx", out}), 1, out + ": a volume mesh cannot hold triangles");
  write("flat.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 1\n");
  expect_error(reeb({"convert", "flat.off", "flat.smc"}), 1, "flat.smc: SMC cannot hold");
  write("far.off", "OFF\n1 0 0\n1e300 0 0\n");
  expect_error(reeb({"convert", "far.off", "far.sma"}), 1, "far.sma: a value of vertex 0 is beyond float32");
}

}  // namespace
}  // namespace reeb::test
