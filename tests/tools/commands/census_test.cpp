// `reeb info` on surfaces: what it says of real meshes, against a table of facts that an independent program has
// counted (MANIFEST.tsv in the same folder) and against the definitions; and its text.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "io/formats/open_mesh.h"
#include "tests/model/reference_census.h"
#include "tests/support/data.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using nlohmann::json;

struct Fact {
  std::map<std::string, std::string> columns;
  std::string operator[](const std::string& column) const { return columns.at(column); }
  std::uint64_t number(const std::string& column) const { return std::stoull(columns.at(column)); }
};

std::vector<Fact> known_facts() {
  std::ifstream in(mesh_folder() + "/MANIFEST.tsv");
  std::vector<std::string> names;
  std::vector<Fact> facts;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    Fact fact;
    std::size_t k = 0;
    for (std::string field; std::getline(fields, field, '\t'); ++k) {
      if (facts.empty() && fact.columns.empty() && line.starts_with("file\t"))
        names.push_back(field);
      else
        fact.columns[names.at(k)] = field;
    }
    if (!fact.columns.empty()) facts.push_back(std::move(fact));
  }
  return facts;
}

class Census : public ProgramTest {
 protected:
  json info(std::vector<std::string> words, Command command = {}) {
    words.insert(words.begin(), {"info", "--json"});
    const Outcome outcome = reeb(words, std::move(command));
    expect_success(outcome);
    return outcome.exit_code == 0 ? json::parse(outcome.output) : json();
  }
};

// A triangle, an edge and a triangle that repeats a corner, in a binary PLY file, which is looked up.
TEST_F(Census, AFaceOfTwoCornersIsNoTriangle) {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 3\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&ply](const auto& value) { ply.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 5.f, 5.f, 5.f}) put(x);
  for (const std::vector<std::int32_t>& face : {std::vector<std::int32_t>{2, 3}, {0, 1, 2}, {0, 1, 1}}) {
    put(static_cast<std::uint8_t>(face.size()));
    for (const std::int32_t corner : face) put(corner);
  }
  write("m.ply", ply);
  const json surface = info({"m.ply"});
  EXPECT_EQ(surface["degenerate"]["count"], 1);
  EXPECT_EQ(surface["degenerate"]["places"][0]["vertices"], json({0, 1}));
  EXPECT_EQ(surface["loose_edges"], 1);
  expect_success(reeb({"defects", "m.ply", "-o", "d.json", "--quiet"}));
  EXPECT_EQ(json::parse(file("d.json"))["degenerate"]["count"], 1);
}

Complex read_complex(const std::string& path) {
  Complex complex;
  const auto reader = io::open_mesh(path);
  for (MeshBatch batch; reader->read(batch);) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i)
      complex.positions.push_back({batch.coordinates[0][i], batch.coordinates[1][i], batch.coordinates[2][i]});
    batch.for_each_simplex([&](std::span<const VertexId> corners) {
      std::vector<std::uint64_t>& simplex = complex.simplices.emplace_back();
      for (const VertexId v : corners) simplex.push_back(v.value());
    });
  }
  return complex;
}

// The table counts repeated triangles as triangles of their own. So of a mesh with duplicates, only what does not
// depend on that is compared; the definitions give the rest.
void expect_as_known(const json& info, const Fact& fact) {
  EXPECT_EQ(info["vertices"], fact.number("vertices"));
  EXPECT_EQ(info["unreferenced_vertices"], fact.number("isolated_vertices"));
  EXPECT_EQ(info["components"]["count"], fact.number("components_b0"));
  if (fact["manifold"] == "tets") {
    EXPECT_TRUE(info["boundaries"].is_null());
    EXPECT_EQ(info["genus_why"], "it is not a surface: it has cells");
    return;
  }
  EXPECT_EQ(info["triangles"], fact.number("triangles"));
  EXPECT_EQ(info["euler"], std::stoll(fact["euler"]));
  EXPECT_EQ(info["degenerate"]["count"], fact.number("degenerate"));
  EXPECT_EQ(info["duplicates"]["count"], fact.number("duplicate"));
  const bool orientable = fact["orientable"] == "y" || fact["orientable"] == "o";
  if (fact["orientable"] != "-") {
    EXPECT_EQ(info["orientable"], orientable);
    EXPECT_EQ(info["oriented"], fact["orientable"] == "y");
  }
  if (fact.number("duplicate") != 0) return;
  EXPECT_EQ(info["boundaries"]["count"], fact.number("boundary_loops"));
  EXPECT_EQ(info["nonmanifold_edges"]["count"], fact.number("nonmanifold_edges"));
  EXPECT_EQ(info["nonmanifold_vertices"]["count"], fact.number("nonmanifold_vertices"));
  EXPECT_EQ(info["closed"], fact.number("boundary_loops") == 0);
  if (fact["manifold"] == "no")
    EXPECT_TRUE(info["genus"].is_null());
  else
    EXPECT_EQ(info["genus"], fact.number("genus_sum"));
}

void expect_as_defined(const json& info, const ReferenceCensus& expected) {
  EXPECT_EQ(info["components"]["count"], expected.components.size());
  EXPECT_EQ(info["boundaries"]["count"], expected.boundaries.size());
  EXPECT_EQ(info["nonmanifold_edges"]["count"], expected.nonmanifold_edges.size());
  EXPECT_EQ(info["nonmanifold_vertices"]["count"], expected.nonmanifold_vertices.size());
  EXPECT_EQ(info["folded"]["count"], expected.folded.size());
  EXPECT_EQ(info["euler"], expected.euler);
}

TEST_F(Census, OfRealMeshes) {
  REEB_REQUIRE_MESHES();
  const std::vector<Fact> facts = known_facts();
  ASSERT_GE(facts.size(), 10u);
  for (const Fact& fact : facts) {
    SCOPED_TRACE(fact["file"]);
    const std::string path = mesh_folder() + "/" + fact["file"];
    const json whole = info({path});
    expect_as_known(whole, fact);
    constexpr std::uint64_t kMostForModel = 120'000;
    if (fact.number("triangles") > kMostForModel || fact["manifold"] == "tets") continue;
    expect_as_defined(whole, reference_census(read_complex(path)));
    EXPECT_EQ(info({path, "--memory", "4M"}), whole);
  }
}

TEST_F(Census, InTextASurfaceHasALineForEachKindOfDefect) {
  write("good.off", kSmallOff);
  EXPECT_NE(reeb({"info", "good.off"})
                .output.find("  components    1\n  boundaries    none\n  non-manifold  none\n"
                             "  degenerate    none\n  duplicates    none\n"
                             "  folded        none\n  orientation   consistent\n  genus         0\n"),
            std::string::npos);
  write("bad.off",
        "OFF\n8 8 0\n0 0 0\n1 0 0\n0 1 0\n0 1 0.01\n5 0 0\n6 0 0\n5 1 0\n5 0 1\n3 0 1 2\n3 1 0 3\n3 0 1 1\n"
        "3 4 5 6\n3 4 5 7\n3 4 5 0\n3 4 5 0\n3 2 2 3\n");
  const std::string text = reeb({"info", "bad.off"}).output;
  for (const std::string line : {
           "  components    1\n",
           "  boundaries    1, of 10 edges and length 20.6569 at vertex 0 (0, 0, 0)\n",
           "  non-manifold  1 edge: vertices 4, 5 (5.5, 0, 0)\n",
           "  non-manifold  5 vertices, the first at vertex 0 (0, 0, 0)\n",
           "  degenerate    2 triangles, the first at vertices 0, 1 (0.5, 0, 0)\n",
           "  duplicates    1 triangle: vertices 0, 4, 5 (3.66667, 0, 0)\n",
           "  folded        1 edge: vertices 0, 1 (0.5, 0, 0)\n",
           "  loose edges   1\n",
           "  orientation   not defined: it has 1 non-manifold edge\n",
           // 8 vertices, 13 edges (six of 0 to 3, five of 4 to 7, {0, 4} and {0, 5}) and 5 different triangles
           "  genus         not defined: it has 1 non-manifold edge (Euler characteristic 0)\n",
       })
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST_F(Census, OfAnImageOnlyComponentsAreCounted) {
  write("i.raw", std::string(4 * 12, '\0'));
  const json found = info({"i.raw", "--grid", "4x3", "--type", "f32le"});
  EXPECT_EQ(found["components"]["count"], 1);
  EXPECT_TRUE(found["boundaries"].is_null());
  EXPECT_EQ(found["genus_why"], "it is not a surface: it is an image");
  EXPECT_NE(
      reeb({"info", "i.raw", "--grid", "4x3", "--type", "f32le"}).output.find("  surface       no: it is an image"),
      std::string::npos);
}

TEST_F(Census, LengthsNearTheEndOfTheDoublesAreNumbers) {
  const auto triangle = [](const std::string& x) {
    return "OFF\n3 1 0\n-" + x + " 0 0\n" + x + " 0 0\n0 0 0\n3 0 1 2\n";
  };
  write("large.off", triangle("1e200"));
  EXPECT_NEAR(info({"large.off"})["boundaries"]["places"][0]["length"].get<double>() / 4e200, 1, 1e-12);
  write("huge.off", triangle("1.7e308"));
  EXPECT_TRUE(info({"huge.off"})["boundaries"]["places"][0]["length"].is_null());
  const Outcome text = reeb({"info", "huge.off"});
  EXPECT_NE(text.output.find("of 3 edges and length inf at"), std::string::npos) << text.output;
}

// However a mesh is read, what is counted is the same.
TEST_F(Census, IsTheSameInEveryFormat) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "--order", "random", "-o", "t.ply"}));
  const auto counts = [](json found) {
    for (const char* name : {"path", "format", "bytes", "notes", "finalization", "finalized_vertices", "live_front"})
      found.erase(name);
    return found;
  };
  const json expected = counts(info({"t.ply"}));
  EXPECT_EQ(expected["genus"], 1);
  for (const std::string name : {"t.obj", "t.off", "t2.ply"}) {
    expect_success(reeb({"convert", "t.ply", name}));
    EXPECT_EQ(counts(info({name})), expected) << name;
  }
  // Streams number vertices in another order.
  for (const std::string name : {"t.smb", "t.smc", "t.sma"}) {
    expect_success(reeb({"convert", "t.ply", name}));
    const json found = info({name});
    for (const char* count : {"genus", "euler", "oriented", "closed", "triangles", "boundaries", "folded"})
      EXPECT_EQ(found[count], expected[count]) << name << ' ' << count;
    Command command;
    command.input = in_folder(name);
    EXPECT_EQ(info({"-"}, command)["genus"], 1) << name;
  }
}

}  // namespace
}  // namespace reeb::test
