// `reeb segment`: its outputs, its inputs, and what it refuses.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class SegmentProgram : public ProgramTest {
 protected:
  template <class Number>
  std::vector<Number> numbers(const std::string& path) {
    const std::string bytes = file(path);
    EXPECT_EQ(bytes.size() % sizeof(Number), 0u) << path;
    std::vector<Number> result(bytes.size() / sizeof(Number));
    std::memcpy(result.data(), bytes.data(), result.size() * sizeof(Number));
    return result;
  }
  // The labels of a run with these further words.
  std::vector<std::int64_t> labels(const std::string& mesh, const std::string& graph,
                                   const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"segment", mesh, graph, "-o", "l.i64", "--force", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    expect_success(reeb(words));
    return numbers<std::int64_t>("l.i64");
  }
  // A vertex property of a mesh, as whole numbers.
  std::vector<std::int64_t> property(const std::string& mesh, const std::string& name) {
    expect_success(reeb({"function", mesh, "-f", "property:" + name, "-o", "p.f64", "--force", "--quiet"}));
    const std::vector<double> values = numbers<double>("p.f64");
    return {values.begin(), values.end()};
  }
};

TEST_F(SegmentProgram, WritesTheSameLabelsInEveryFormat) {
  expect_success(reeb({"generate", "scan", "--triangles", "3k", "-o", "s.ply"}));
  expect_success(reeb({"compute", "s.ply", "--quiet"}));
  for (const std::vector<std::string>& level : {std::vector<std::string>{}, {"--threshold", "2%"}, {"--nodes", "30"}}) {
    const std::vector<std::int64_t> expected = labels("s.ply", "s.reeb", level);
    EXPECT_GT(std::ranges::max(expected), 10);
    for (const std::string out : {"o.ply", "o.vtu", "o.vtp"}) {
      std::vector<std::string> words{"segment", "s.ply", "s.reeb", "-o", out, "--force"};
      words.insert(words.end(), level.begin(), level.end());
      expect_success(reeb(words));
      EXPECT_EQ(property(out, out == "o.ply" ? "arc" : "SegmentationId"), expected) << out;
    }
    EXPECT_EQ(labels("o.ply", "s.reeb", level), expected);
    EXPECT_EQ(labels("o.vtu", "s.reeb", level), expected);
    std::vector<std::string> limited = level;
    limited.insert(limited.end(), {"--memory", "16M", "--threads", "1"});
    EXPECT_EQ(labels("s.ply", "s.reeb", limited), expected);
  }
  // The labels of the labelled mesh replace the earlier ones, and that is said.
  const Outcome again = reeb({"segment", "o.ply", "s.reeb", "-o", "again.ply"});
  expect_success(again);
  EXPECT_NE(unwrapped(again.error).find("which the labels replaced"), std::string::npos) << again.error;
  EXPECT_EQ(property("again.ply", "arc"), labels("s.ply", "s.reeb", {}));
  expect_success(reeb({"function", "s.ply", "-f", "z", "-o", "z.f64", "--quiet"}));
  expect_success(reeb({"function", "o.vtp", "-f", "property:Value", "-o", "v.f64", "--quiet"}));
  EXPECT_EQ(file("v.f64"), file("z.f64"));
}

TEST_F(SegmentProgram, SaysInWhichOrderTheFilesAre) {
  write("s.off", kSmallOff);
  expect_success(reeb({"compute", "s.off", "--quiet"}));
  const Outcome swapped = reeb({"segment", "s.reeb", "s.off", "-o", "l.i64"});
  expect_error(swapped, 1, "s.reeb: this is a Reeb graph, not a mesh");
  EXPECT_EQ(lines_after("hint: ", swapped.error).at(0), "name the mesh first: reeb segment MESH FILE.reeb -o OUT");
  EXPECT_EQ(lines_after("hint: ", reeb({"segment", "s.off", "s.off", "-o", "l.i64"}).error).at(0),
            "first `reeb s.off`, then `reeb segment s.off s.reeb`");
}

TEST_F(SegmentProgram, ACutFileHasTheLevelsOfItsWholeFrames) {
  expect_success(reeb({"generate", "scan", "--triangles", "400k", "--seed", "3", "-o", "s.ply"}));
  expect_success(reeb({"compute", "s.ply", "--quiet"}));
  const std::string whole = file("s.reeb");
  write("cut.reeb", whole.substr(0, whole.size() * 6 / 10));
  const auto expected = labels("s.ply", "s.reeb", {"--nodes", "100"});
  EXPECT_EQ(labels("s.ply", "cut.reeb", {"--nodes", "100"}), expected);
  const Outcome outcome = reeb({"segment", "s.ply", "cut.reeb", "-o", "f.i64"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.error.find("frames are whole"), std::string::npos) << outcome.error;
  const std::string hint = lines_after("hint: ", outcome.error).at(0);
  ASSERT_TRUE(hint.starts_with("--")) << hint;
  const std::size_t value = hint.find(' ') + 1;
  const std::vector<std::string> level{hint.substr(0, value - 1), hint.substr(value, hint.find(' ', value) - value)};
  EXPECT_EQ(labels("s.ply", "cut.reeb", level), labels("s.ply", "s.reeb", level));
  // Another mesh of the same size, whose graph differs.
  expect_success(reeb({"generate", "scan", "--triangles", "400k", "--seed", "4", "-o", "other.ply"}));
  EXPECT_EQ(reeb({"segment", "other.ply", "cut.reeb", "-o", "f.i64", "--nodes", "100"}).exit_code, 1);
}

TEST_F(SegmentProgram, ReadsImagesInBoxesAsTheirDivision) {
  expect_success(reeb({"generate", "volume", "--grid", "40x36x35", "--handles", "3", "-o", "v.nrrd"}));
  expect_success(reeb({"function", "v.nrrd", "-o", "v.ply", "--quiet"}));
  expect_success(reeb({"compute", "v.nrrd", "--quiet"}));
  const std::vector<std::int64_t> expected = labels("v.nrrd", "v.reeb");
  EXPECT_EQ(expected.size(), 40u * 36 * 35);
  expect_success(reeb({"compute", "v.ply", "-f", "property:value", "-o", "p.reeb", "--quiet"}));
  EXPECT_EQ(labels("v.ply", "p.reeb"), expected);
}

TEST_F(SegmentProgram, LeavesOutVerticesWithoutData) {
  write("g.asc", "ncols 4\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n1 2 -1 4\n5 6 7 8\n");
  expect_success(reeb({"compute", "g.asc", "--nodata", "skip", "--quiet"}));
  const std::vector<std::int64_t> expected = labels("g.asc", "g.reeb", {"--nodata", "skip"});
  const std::int64_t none = std::int64_t{-1} << 63;
  ASSERT_EQ(expected.size(), 8u);
  EXPECT_EQ(expected[2], none);
  EXPECT_EQ(std::ranges::count(expected, none), 1);
  expect_success(reeb({"segment", "g.asc", "g.reeb", "--nodata", "skip", "-o", "g.vtu"}));
  std::vector<std::int64_t> present = expected;
  std::erase(present, none);
  EXPECT_EQ(property("g.vtu", "SegmentationId"), present);
}

TEST_F(SegmentProgram, NamesTheMeshAndTheGraphOfAnotherOne) {
  expect_success(reeb({"generate", "scan", "--triangles", "3k", "-o", "small.ply"}));
  expect_success(reeb({"generate", "scan", "--triangles", "30k", "-o", "big.ply"}));
  expect_success(reeb({"compute", "small.ply", "--quiet"}));
  const Outcome outcome = reeb({"segment", "big.ply", "small.reeb", "-o", "l.i64", "--quiet"});
  expect_error(outcome, 1, "big.ply: the mesh has a vertex ");
  EXPECT_NE(outcome.error.find(", but the mesh of small.reeb has "), std::string::npos) << outcome.error;
}

TEST_F(SegmentProgram, RefusesWhatItCannotLabel) {
  expect_success(reeb({"generate", "torus", "--triangles", "500", "-o", "t.ply"}));
  expect_success(reeb({"generate", "torus", "--triangles", "700", "-o", "other.ply"}));
  expect_success(reeb({"compute", "t.ply", "--quiet"}));
  expect_success(reeb({"compute", "t.ply", "--graph-only", "-o", "g.reeb", "--quiet"}));
  expect_error(reeb({"segment", "other.ply", "t.reeb", "-o", "a.i64"}), 1);
  expect_error(reeb({"segment", "t.reeb", "t.reeb", "-o", "a.i64"}), 1);
  expect_error(reeb({"segment", "t.ply", "t.ply", "-o", "a.i64"}), 1);
  expect_error(reeb({"segment", "t.ply", "t.reeb", "-o", "t.ply", "--force"}), 1);
  expect_error(reeb({"segment", "t.ply", "t.reeb", "-o", "a.txt"}), 2);
  expect_error(reeb({"segment", "t.ply", "t.reeb", "-o", "a.i64", "--threshold", "x"}), 2);
  expect_error(reeb({"segment", "t.ply", "g.reeb", "-o", "a.i64", "--threshold", "1%"}), 1);
  expect_error(reeb({"segment", "t.ply", "g.reeb", "-o", "a.i64", "--nodes", "2"}), 1);
  EXPECT_FALSE(std::filesystem::exists(folder() + "/a.i64"));
  expect_success(reeb({"segment", "t.ply", "g.reeb", "-o", "a.i64"}));
  expect_error(reeb({"segment", "t.ply", "t.reeb", "-o", "a.i64"}), 1);
  EXPECT_EQ(numbers<std::int64_t>("a.i64"), labels("t.ply", "t.reeb"));
}

TEST_F(SegmentProgram, ReadsTheValuesOfAFileAgain) {
  expect_success(reeb({"generate", "torus", "--triangles", "500", "-o", "t.ply"}));
  expect_success(reeb({"function", "t.ply", "-f", "random:3", "-o", "v.f64", "--quiet"}));
  expect_success(reeb({"compute", "t.ply", "-f", "random:3", "-o", "r.reeb", "--quiet"}));
  expect_success(reeb({"compute", "t.ply", "-f", "file:v.f64", "-o", "f.reeb", "--quiet"}));
  const std::vector<std::int64_t> expected = labels("t.ply", "r.reeb", {"--threshold", "10%"});
  EXPECT_EQ(labels("t.ply", "f.reeb", {"--threshold", "10%"}), expected);
  EXPECT_EQ(labels("t.ply", "f.reeb"), labels("t.ply", "r.reeb"));
  expect_success(reeb({"function", "t.ply", "-f", "random:4", "-o", "v.f64", "--quiet", "--force"}));
  expect_error(reeb({"segment", "t.ply", "f.reeb", "-o", "a.i64"}), 1);
  std::filesystem::remove(folder() + "/v.f64");
  expect_error(reeb({"segment", "t.ply", "f.reeb", "-o", "a.i64"}), 1);
}

// Circles of two parallel arcs, with one vertex on one of them and two on the other. The means of their positions are
// equal.
TEST_F(SegmentProgram, ExtractNumbersParallelArcsAsSegmentDoes) {
  const std::vector<std::vector<std::uint64_t>> orders = {{2, 3, 4}, {3, 2, 4}, {4, 2, 3}, {4, 3, 2}};
  for (const auto& order : orders) {  // the vertices at 2, 1 and 3
    const auto number = [&](std::size_t i) { return std::to_string(order[i]); };
    std::vector<std::string> height(5);
    height[0] = "0", height[1] = "4";
    for (std::size_t i = 0; i < 3; ++i) height[order[i]] = std::to_string(i == 0 ? 2 : i == 1 ? 1 : 3);
    std::string mesh;
    for (const std::string& z : height) mesh += "v 0 0 " + z + "\n";
    mesh += "s 0 " + number(0) + "\ns " + number(0) + " 1\ns 0 " + number(1) + "\ns " + number(1) + " " + number(2) +
            "\ns " + number(2) + " 1\n";
    write("c.cx", mesh);
    expect_success(reeb({"compute", "c.cx", "-o", "c.reeb", "--quiet", "--force"}));
    const std::vector<std::int64_t> expected = labels("c.cx", "c.reeb");
    expect_success(reeb({"extract", "c.reeb", "--mesh", "c.cx", "-o", "c.json", "--force"}));
    const auto graph = nlohmann::json::parse(file("c.json"));
    ASSERT_EQ(graph["arcs"].size(), 2u);
    for (std::size_t a = 0; a < 2; ++a) {
      EXPECT_EQ(graph["arcs"][a]["segment_vertices"], std::ranges::count(expected, static_cast<std::int64_t>(a)));
      EXPECT_EQ(graph["arcs"][a]["segment_vertices"], graph["arcs"][a]["vertices"]);
    }
  }
}

// A torus of radii 1 and 0.5 that stands on its side. Its contours at the level 0 are circles of radius 0.5.
TEST_F(SegmentProgram, ExtractMeasuresArcsOnTheMesh) {
  expect_success(reeb({"generate", "torus", "--triangles", "20k", "-o", "t.ply"}));
  expect_success(reeb({"compute", "t.ply", "--quiet"}));
  expect_success(reeb({"extract", "t.reeb", "--mesh", "t.ply", "-o", "t.json"}));
  const auto graph = nlohmann::json::parse(file("t.json"));
  const std::vector<std::int64_t> expected = labels("t.ply", "t.reeb");
  ASSERT_EQ(graph["arcs"].size(), 4u);
  constexpr double kPi = std::numbers::pi;
  double area = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const auto& arc = graph["arcs"][a];
    EXPECT_EQ(arc["segment_vertices"], arc["vertices"]);
    EXPECT_EQ(arc["segment_vertices"], std::ranges::count(expected, static_cast<std::int64_t>(a)));
    area += arc["area"].get<double>();
    EXPECT_NEAR(arc["shortest_contour"].get<double>(), a == 1 || a == 2 ? kPi : 0, 0.01);
    EXPECT_NEAR(arc["mean"].get<double>(), a == 0 ? -0.9 : a == 3 ? 0.9 : 0, 0.05);
  }
  EXPECT_NEAR(area, 2 * kPi * kPi, 0.05);

  expect_success(reeb({"extract", "t.reeb", "--mesh", "t.ply", "-o", "t.vtu"}));
  const std::string text = file("t.vtu");
  for (const std::string name : {"SegmentVertices", "Mean", "Area", "ShortestContour"})
    EXPECT_NE(text.find("Name=\"" + name + '"'), std::string::npos) << name;
  // A file without buckets says nothing of parallel arcs, and has the same measures.
  expect_success(reeb({"compute", "t.ply", "--buckets", "0", "-o", "b.reeb", "--quiet"}));
  expect_success(reeb({"extract", "b.reeb", "--mesh", "t.ply", "-o", "b.json"}));
  const auto without_buckets = nlohmann::json::parse(file("b.json"));
  ASSERT_EQ(without_buckets["arcs"].size(), 4u);
  for (std::size_t a = 0; a < 4; ++a)
    for (const char* measure : {"segment_vertices", "mean", "area", "shortest_contour"})
      EXPECT_EQ(without_buckets["arcs"][a].at(measure), graph["arcs"][a].at(measure)) << measure << " of arc " << a;
}

TEST_F(SegmentProgram, ExtractRefusesToMeasureWhatItCannot) {
  expect_success(reeb({"generate", "torus", "--triangles", "500", "-o", "t.ply"}));
  expect_success(reeb({"generate", "torus", "--triangles", "700", "-o", "other.ply"}));
  expect_success(reeb({"compute", "t.ply", "--quiet"}));
  expect_error(reeb({"extract", "t.reeb", "--mesh", "t.ply", "-o", "t.csv"}), 2);
  expect_error(reeb({"extract", "t.reeb", "--mesh", "other.ply", "-o", "t.json"}), 1);
  expect_error(reeb({"extract", "t.reeb", "--mesh", "t.ply", "-o", "t.ply", "--format", "json", "--force"}), 1);
  expect_error(reeb({"extract", "t.reeb", "--mesh", "none.ply", "-o", "t.json"}), 1);
  expect_error(reeb({"extract", "t.reeb", "--threads", "2"}), 2);
  EXPECT_FALSE(std::filesystem::exists(folder() + "/t.json"));
}

}  // namespace
}  // namespace reeb::test
