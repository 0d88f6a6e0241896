// `reeb repair` on meshes with planted tunnels and bridges; counted again by plain code.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/inputs/plain_surface.h"
#include "tests/support/inputs/planted_mesh.h"
#include "tests/support/random.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using Triangle = std::array<std::array<double, 3>, 3>;

// Vertices and triangles of `before` that are in `after` come first, in their order.
void expect_order_kept(const PlainSurface& before, const PlainSurface& after, std::size_t removed, std::size_t added) {
  ASSERT_EQ(after.triangles.size(), before.triangles.size() - removed + added);
  std::vector<Triangle> old, kept;
  const auto place = [](const PlainSurface& s, const std::array<std::uint32_t, 3>& t) {
    return Triangle{s.vertices[t[0]], s.vertices[t[1]], s.vertices[t[2]]};
  };
  std::size_t next = 0;
  for (std::size_t i = 0; i + added < after.triangles.size(); ++i) {
    const Triangle t = place(after, after.triangles[i]);
    while (next < before.triangles.size() && place(before, before.triangles[next]) != t) ++next;
    ASSERT_LT(next++, before.triangles.size()) << "triangle " << i;
  }
  next = 0;
  std::size_t i = 0;
  for (; i < after.vertices.size(); ++i) {
    std::size_t at = next;
    while (at < before.vertices.size() && before.vertices[at] != after.vertices[i]) ++at;
    if (at == before.vertices.size()) break;  // new ones
    next = at + 1;
  }
  for (; i < after.vertices.size(); ++i)
    EXPECT_EQ(std::ranges::find(before.vertices, after.vertices[i]), before.vertices.end()) << i;
}

class RepairTest : public ProgramTest {
 protected:
  PlainSurface ply(const std::string& name) const { return read_plain_ply(file(name)); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(file(name)); }
  // The shorter curve of each row of a table without quotes; infinity where no curve was found.
  std::vector<double> lengths_in(const std::string& name) const {
    std::istringstream lines(file(name));
    std::string line;
    std::getline(lines, line);
    const auto fields_of = [](const std::string& row) {
      std::istringstream fields(row);
      std::vector<std::string> list;
      for (std::string field; std::getline(fields, field, ',');) list.push_back(field);
      return list;
    };
    const auto titles = fields_of(line);
    std::vector<double> lengths;
    while (std::getline(lines, line)) {
      double length = INFINITY;
      for (const char* const title : {"length_contour", "length_cycle"}) {
        const auto place = static_cast<std::size_t>(std::ranges::find(titles, title) - titles.begin());
        if (const std::string field = fields_of(line).at(place); !field.empty())
          length = std::min(length, std::stod(field));
      }
      lengths.push_back(length);
    }
    return lengths;
  }
};

TEST_F(RepairTest, CutsPlantedDefectsAndNothingElse) {
  const bool all = std::getenv("REEB_TEST_ALL") != nullptr;
  const std::size_t meshes = all ? 60 : 3;
  std::size_t planted = 0, repaired = 0;
  std::string misses;
  for (std::size_t seed = 1; seed <= meshes; ++seed) {
    PlantedOptions options;
    options.seed = seed;
    options.least_radius = 1;
    options.noise = seed % 3 == 0 ? 0.05 : 0;
    options.inwards = seed % 4 == 1;
    const PlantedMesh mesh = planted_mesh(options);
    write("m.off", to_off(mesh));
    const PlainSurface before = read_plain_off(file("m.off"));
    const SurfaceCount count = recount(before);
    ASSERT_TRUE(count.is_closed_manifold());
    expect_success(reeb({"repair", "m.off", "-o", "r.ply", "--longest", "26", "--log", "r.json", "--undo", "r.undo",
                         "--force", "--quiet"}));
    const PlainSurface after = ply("r.ply");
    const SurfaceCount again = recount(after);
    const auto log = json("r.json");
    std::size_t removed = 0, added = 0;
    for (const auto& row : log["loops"]) {
      removed += std::size_t{row["triangles_removed"]};
      added += std::size_t{row["triangles_added"]};
    }
    EXPECT_EQ(log["schema"], "reeb.repair.v1");
    EXPECT_EQ(log["repaired"], log["loops"].size());
    EXPECT_EQ(log["loops"].size() + log["left"].size(), static_cast<std::size_t>(count.genus()));
    EXPECT_EQ(again.genus(), count.genus() - static_cast<std::int64_t>(log["repaired"])) << seed;
    EXPECT_EQ(again.components, count.components) << seed;
    EXPECT_TRUE(again.is_closed_manifold()) << seed;
    EXPECT_EQ(again.unoriented_edges, 0u) << seed;
    EXPECT_EQ(again.unused_vertices, 0u) << seed;
    EXPECT_NE(after.header.find("property double x"), std::string::npos);
    expect_order_kept(before, after, removed, added);
    planted += mesh.planted.size();
    repaired += std::min(mesh.planted.size(), log["loops"].size());
    if (log["loops"].size() != mesh.planted.size())
      misses += "seed " + std::to_string(seed) + ": " + std::to_string(mesh.planted.size()) + " planted, " +
                log.dump(1) + '\n';
    if (const char* folder = std::getenv("REEB_TEST_KEEP")) {
      write_file(folder + ("/m" + std::to_string(seed) + ".off"), file("m.off"));
      write_file(folder + ("/r" + std::to_string(seed) + ".ply"), file("r.ply"));
    }

    // Only genuine handles are listed now.
    expect_success(reeb({"defects", "r.ply", "-o", "after.csv", "--force", "--quiet"}));
    const std::vector<double> lengths = lengths_in("after.csv");
    EXPECT_EQ(lengths.size(), static_cast<std::size_t>(again.genus())) << seed;
    for (const double length : lengths) EXPECT_FALSE(length <= 26) << seed;

    expect_success(reeb({"repair", "r.ply", "--apply-undo", "r.undo", "-o", "b.ply", "--force", "--quiet"}));
    const PlainSurface back = ply("b.ply");
    EXPECT_TRUE(back.vertices == before.vertices) << seed;
    EXPECT_TRUE(back.triangles == before.triangles) << seed;
  }
  EXPECT_GE(static_cast<double>(repaired), 0.98 * static_cast<double>(planted)) << misses;
  if (all) std::fprintf(stderr, "%zu of %zu planted repaired\n%s", repaired, planted, misses.c_str());
}

std::string to_off(const PlainSurface& surface) {
  PlantedMesh mesh;
  mesh.vertices = surface.vertices;
  mesh.triangles = surface.triangles;
  return to_off(mesh);
}

TEST_F(RepairTest, DropsAndFillsWhatIsAskedFor) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  PlainSurface torus = read_plain_ply(file("t.ply"));
  const auto drop = [&](std::uint32_t v) {
    std::erase_if(torus.triangles, [&](const auto& t) { return std::ranges::find(t, v) != t.end(); });
  };
  drop(100);
  drop(300);  // two boundaries, and two vertices that nothing uses
  const SurfaceCount open = recount(torus);
  ASSERT_GT(open.boundary_edges, 6u);
  ASSERT_EQ(open.unused_vertices, 2u);
  PlainSurface good = torus;
  // Later come a tetrahedron, repetitions, and triangles that repeat a corner, one of them with a vertex of its own.
  const auto base = static_cast<std::uint32_t>(torus.vertices.size());
  for (int k = 0; k < 5; ++k) torus.vertices.push_back({9.0 + (k & 1), (k & 2) / 2.0, k == 3 ? 1.0 : 0.0});
  for (const auto& t : std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}})
    torus.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  torus.triangles.insert(torus.triangles.begin() + 7, torus.triangles[3]);
  torus.triangles.push_back({torus.triangles[5][1], torus.triangles[5][2], torus.triangles[5][0]});
  torus.triangles.push_back({4, 4, 5});
  torus.triangles.push_back({base + 4, base + 4, base + 4});
  write("d.off", to_off(torus));
  torus.vertices = read_plain_off(file("d.off")).vertices;  // rounded
  std::copy_n(torus.vertices.begin(), good.vertices.size(), good.vertices.begin());

  const std::vector<std::string> rest = {"--longest", "0", "--force", "--quiet", "--log", "log.json", "--undo", "u"};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"repair", "d.off", "-o", "o.ply"});
    words.insert(words.end(), rest.begin(), rest.end());
    expect_success(reeb(words));
    const PlainSurface result = ply("o.ply");
    expect_success(reeb({"repair", "o.ply", "--apply-undo", "u", "-o", "back.ply", "--force", "--quiet"}));
    EXPECT_TRUE(ply("back.ply").vertices == torus.vertices);
    EXPECT_TRUE(ply("back.ply").triangles == torus.triangles);
    return result;
  };
  PlainSurface now = run({});
  EXPECT_TRUE(now.triangles == torus.triangles);
  EXPECT_TRUE(now.vertices == torus.vertices);
  now = run({"--drop-duplicates"});
  EXPECT_EQ(now.triangles.size(), torus.triangles.size() - 2);
  EXPECT_EQ(now.triangles[7], good.triangles[7]);
  EXPECT_EQ(json("log.json")["duplicates_dropped"], 2);
  now = run({"--drop-degenerate"});
  EXPECT_EQ(now.triangles.size(), torus.triangles.size() - 2);
  EXPECT_EQ(now.vertices.size(), torus.vertices.size() - 1);  // the one of its own
  EXPECT_EQ(json("log.json")["degenerate_dropped"], 2);
  now = run({"--drop-components", "1%"});
  EXPECT_EQ(now.triangles.size(), torus.triangles.size() - 5);
  EXPECT_EQ(now.vertices.size(), torus.vertices.size() - 5);
  EXPECT_EQ(json("log.json")["components_dropped"], 2);
  now = run({"--drop-components", "0.1%"});
  EXPECT_EQ(now.triangles.size(), torus.triangles.size() - 1);
  now = run({"--drop-duplicates", "--drop-degenerate", "--drop-components", "1%"});
  EXPECT_TRUE(now.triangles == good.triangles);
  EXPECT_TRUE(now.vertices == good.vertices);
  now = run({"--drop-duplicates", "--drop-degenerate", "--drop-components", "1%", "--fill-boundaries", "10"});
  EXPECT_EQ(json("log.json")["boundaries_filled"], 2);
  const SurfaceCount count = recount(now);
  EXPECT_TRUE(count.is_closed_manifold());
  EXPECT_EQ(count.unoriented_edges, 0u);
  EXPECT_EQ(count.genus(), 1);
  EXPECT_EQ(count.unused_vertices, 2u);
  EXPECT_TRUE(std::equal(good.triangles.begin(), good.triangles.end(), now.triangles.begin()));
  now = run({"--drop-duplicates", "--fill-boundaries", "0.001"});
  EXPECT_EQ(json("log.json")["boundaries_filled"], 0);
  const auto left = json("log.json")["boundaries_left"];
  ASSERT_FALSE(left.empty());
  for (const auto& why : left) EXPECT_EQ(why, "it is longer than --fill-boundaries LENGTH");
}

// A triangle that is dropped joins no components, and its vertices are dropped with it.
TEST_F(RepairTest, ComponentsAreThoseWithoutTheTrianglesThatAreDropped) {
  PlainSurface mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {4, 5, 6}, {0, 4, 4}, {6, 7, 7}};
  write("d.off", to_off(mesh));
  const std::vector<std::string> words = {"repair", "d.off",  "-o", "o.ply", "--all", "--drop-components",
                                          "50%",    "--force"};
  expect_success(reeb(words));
  EXPECT_EQ(ply("o.ply").triangles.size(), 7u);
  std::vector<std::string> both = words;
  both.emplace_back("--drop-degenerate");
  const Outcome outcome = reeb(both);
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("1 component of 1 triangle dropped\n"), std::string::npos) << outcome.error;
  EXPECT_EQ(ply("o.ply").triangles.size(), 4u);
  EXPECT_EQ(ply("o.ply").vertices.size(), 4u);
}

// A share of the largest component: what has fewer triangles than that is dropped.
TEST_F(RepairTest, ComponentsOfJustTheShareAreNotDropped) {
  PlainSurface mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}};
  write("d.off", to_off(mesh));
  for (const auto& [share, triangles] : {std::pair("50%", 3u), std::pair("51%", 2u), std::pair("100%", 2u)}) {
    expect_success(reeb({"repair", "d.off", "-o", "o.ply", "--longest", "0", "--drop-components", share, "--force"}));
    EXPECT_EQ(ply("o.ply").triangles.size(), triangles) << share;
  }
}

// Three faces of a tetrahedron have one boundary. That of a component that is dropped is none, and triangles that are
// listed twice have none of their own.
TEST_F(RepairTest, BoundariesAreThoseOfWhatStays) {
  PlainSurface open;
  open.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  open.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const auto boundaries = [&](const PlainSurface& mesh, const std::vector<std::string>& options) {
    write("d.off", to_off(mesh));
    std::vector<std::string> words = {"repair", "d.off",   "-o",    "o.ply",    "--longest", "0", "--fill-boundaries",
                                      "10",     "--force", "--log", "log.json", "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    expect_success(reeb(words));
    return std::pair(json("log.json")["boundaries_filled"].get<int>(), json("log.json")["boundaries_left"].size());
  };
  EXPECT_EQ(boundaries(open, {}), std::pair(1, std::size_t{0}));
  PlainSurface twice = open;
  twice.triangles.insert(twice.triangles.end(), open.triangles.begin(), open.triangles.end());
  EXPECT_EQ(boundaries(twice, {"--drop-duplicates"}), std::pair(1, std::size_t{0}));
  const auto [filled, left] = boundaries(twice, {});
  EXPECT_EQ(static_cast<std::size_t>(filled) + left, 1u) << "the same boundary, whatever becomes of it";
  PlainSurface two = open;
  for (const auto& place : {std::array{9., 0., 0.}, std::array{10., 0., 0.}, std::array{9., 1., 0.}})
    two.vertices.push_back(place);
  two.triangles.push_back({4, 5, 6});
  EXPECT_EQ(boundaries(two, {"--drop-components", "50%"}), std::pair(1, std::size_t{0}));
}

// `info` prints the length of each boundary; its sums have other last digits.
TEST_F(RepairTest, FillsBoundariesOfTheLengthThatInfoPrints) {
  for (int seed = 0; seed < 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    PlainSurface mesh;
    const std::uint32_t sides = 3 + static_cast<std::uint32_t>(random.below(9));
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 6.283185307179586 * i / sides, radius = 1 + static_cast<double>(random.below(1000)) / 1e4;
      mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    mesh.vertices.push_back({0, 0, 2});
    for (std::uint32_t i = 0; i < sides; ++i) mesh.triangles.push_back({i, (i + 1) % sides, sides});
    write("cone.off", to_off(mesh));
    const Outcome info = reeb({"info", "cone.off", "--json"});
    expect_success(info);
    const auto boundaries = nlohmann::json::parse(info.output)["boundaries"]["places"];
    ASSERT_EQ(boundaries.size(), 1u);
    expect_success(reeb({"repair", "cone.off", "-o", "o.ply", "--longest", "0", "--fill-boundaries",
                         boundaries[0]["length"].dump(), "--force", "--quiet", "--log", "log.json"}));
    EXPECT_EQ(json("log.json")["boundaries_filled"], 1) << seed;
  }
}

TEST_F(RepairTest, TakesRowsOfAnyFunction) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  expect_success(reeb({"compute", "t.ply", "-f", "distance:3,2,1", "-o", "d.reeb", "--quiet"}));
  expect_success(reeb({"defects", "t.ply", "d.reeb", "-o", "d.csv", "--quiet"}));
  ASSERT_NE(file("d.csv").find("distance:3,2,1"), std::string::npos);
  expect_success(reeb({"repair", "t.ply", "-o", "o.ply", "--loops", "d.csv", "--quiet"}));
  EXPECT_EQ(recount(ply("o.ply")).genus(), 0);
  std::string other = file("d.csv");
  other.replace(other.find("\"distance:3,2,1\""), 16, "height");
  write("other.csv", other);
  expect_error(reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "other.csv", "--quiet"}), 1, "other.csv:2");
}

// A torus that is cut loses volume, also if its triangles are turned.
TEST_F(RepairTest, TheVolumeIsThatOfTheSolid) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  PlainSurface torus = read_plain_ply(file("t.ply"));
  std::array<double, 2> gained{};
  for (const std::size_t turned : {0u, 1u}) {
    if (turned == 1)
      for (auto& t : torus.triangles) std::swap(t[1], t[2]);
    write("t.off", to_off(torus));
    expect_success(reeb({"repair", "t.off", "-o", "o.off", "--all", "--log", "log.json", "--quiet", "--force"}));
    gained[turned] = json("log.json")["loops"][0]["volume"];
    EXPECT_LT(gained[turned], 0) << turned;
  }
  EXPECT_NEAR(gained[0], gained[1], 0.05 * std::abs(gained[0]));
}

// Every row that reeb defects wrote is known to reeb repair, whatever graphs it was given.
TEST_F(RepairTest, KnowsAllRowsOfTheTable) {
  expect_success(reeb({"generate", "scan", "--triangles", "6000", "-o", "s.ply"}));
  for (const std::vector<std::string>& functions :
       {std::vector<std::string>{"c0", "c1"}, {"random:1", "y"}, {"z"}, {"y", "x"}}) {
    std::vector<std::string> defects = {"defects", "-o", "d.csv", "--quiet", "--force", "s.ply"};
    for (std::size_t i = 0; i < functions.size(); ++i) {
      defects.push_back(std::to_string(i) + ".reeb");
      expect_success(reeb({"compute", "s.ply", "-f", functions[i], "-o", defects.back(), "--quiet", "--force"}));
    }
    expect_success(reeb(defects));
    const std::string table = file("d.csv");
    const auto rows = std::ranges::count(table, '\n') - 1;
    ASSERT_GT(rows, 2);
    expect_success(
        reeb({"repair", "s.ply", "-o", "o.ply", "--loops", "d.csv", "--log", "log.json", "--quiet", "--force"}));
    const nlohmann::json log = json("log.json");
    const auto others = std::ranges::count(log["left"], "not in the file of --loops",
                                           [](const nlohmann::json& row) { return row["why"]; });
    EXPECT_EQ(log["loops"].size() + log["left"].size() - static_cast<std::size_t>(others),
              static_cast<std::size_t>(rows))
        << functions[0];
    EXPECT_GT(log["repaired"], 0) << functions[0];
  }
}

// Triangles that repeat a corner along edges, and repetitions: what is along the cut goes with it, or would join its
// two sides.
TEST_F(RepairTest, LeavesNothingAcrossACut) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  PlainSurface torus = read_plain_ply(file("t.ply"));
  const std::size_t plain = torus.triangles.size();
  for (std::size_t i = 0; i < plain; ++i) {
    const auto [a, b, c] = torus.triangles[i];
    torus.triangles.push_back(i % 3 == 0 ? std::array{a, b, b} : std::array{a, a, b});
    torus.triangles.push_back({b, c, b});
    torus.triangles.push_back({b, c, a});
  }
  write("d.off", to_off(torus));
  expect_success(reeb({"repair", "d.off", "-o", "o.off", "--all", "--quiet", "--log", "log.json", "--undo", "u"}));
  const nlohmann::json log = json("log.json");
  EXPECT_EQ(log["repaired"], 1);
  const PlainSurface result = read_plain_off(file("o.off"));
  EXPECT_EQ(result.triangles.size() - static_cast<std::size_t>(log["loops"][0]["triangles_added"]) +
                static_cast<std::size_t>(log["loops"][0]["triangles_removed"]),
            torus.triangles.size());
  std::set<std::uint32_t> used;
  PlainSurface cleaned = result;
  std::erase_if(cleaned.triangles, [&](const auto& t) {
    used.insert(t.begin(), t.end());
    return t[0] == t[1] || t[1] == t[2] || t[0] == t[2];
  });
  EXPECT_EQ(used.size(), result.vertices.size());
  std::set<std::set<std::uint32_t>> edges;
  for (const auto& [a, b, c] : cleaned.triangles) edges.insert({{a, b}, {b, c}, {a, c}});
  for (const auto& [a, b, c] : result.triangles)
    if (a == b || b == c || a == c) {
      EXPECT_EQ(edges.count({a, b, c}), 1u) << a << ' ' << b << ' ' << c;
    }
  expect_success(reeb({"compute", "o.off", "-o", "o.reeb", "--quiet", "--report", "report.json"}));
  EXPECT_EQ(json("report.json")["graph"]["loops"], 0);
  expect_success(reeb({"repair", "o.off", "--apply-undo", "u", "-o", "back.off", "--quiet"}));
  EXPECT_TRUE(read_plain_off(file("back.off")).triangles == read_plain_off(file("d.off")).triangles);
}

// An edge of the file cannot be removed, so the loop stays.
TEST_F(RepairTest, LeavesALoopThatAnEdgeOfTheFileCrosses) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  const PlainSurface torus = read_plain_ply(file("t.ply"));
  std::ostringstream text;
  for (const auto& p : torus.vertices) text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& t : torus.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  for (const auto& t : torus.triangles)
    for (std::size_t k = 0; k < 3; ++k) text << "l " << t[k] + 1 << ' ' << t[(k + 1) % 3] + 1 << '\n';
  write("l.obj", text.str());
  expect_success(reeb({"repair", "l.obj", "-o", "o.obj", "--all", "--quiet", "--log", "log.json"}));
  EXPECT_EQ(json("log.json")["repaired"], 0);
  EXPECT_EQ(json("log.json")["left"][0]["why"], "an edge of the file would be left across the cut");
  expect_success(reeb({"compute", "o.obj", "-o", "o.reeb", "--quiet", "--report", "report.json"}));
  EXPECT_EQ(json("report.json")["graph"]["loops"], 1);
}

// Every property of vertices keeps its type and its values; new vertices lie between others.
TEST_F(RepairTest, KeepsPropertiesAndTheirTypes) {
  expect_success(reeb({"generate", "torus", "--triangles", "4000", "-o", "t.ply"}));
  const PlainSurface torus = read_plain_ply(file("t.ply"));
  std::ostringstream text;
  text.precision(9);
  text << "ply\nformat ascii 1.0\nelement vertex " << torus.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty double q\n"
          "property short s\nelement face "
       << torus.triangles.size() << "\nproperty list uchar int vertex_indices\nproperty uchar part\nend_header\n";
  for (std::size_t i = 0; i < torus.vertices.size(); ++i) {
    for (const double x : torus.vertices[i]) text << x << ' ';
    text << 100 + i % 100 << " 7.1 -5\n";
  }
  for (const auto& t : torus.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << " 1\n";
  write("a.ply", text.str());
  const Outcome outcome = reeb({"repair", "a.ply", "-o", "b.ply", "--all", "--undo", "u"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("properties of faces are dropped: part"), std::string::npos) << outcome.error;
  const std::string bytes = file("b.ply");
  const PlainSurface after = read_plain_ply(bytes);
  EXPECT_EQ(recount(after).genus(), 0);
  EXPECT_NE(after.header.find("property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                              "property double q\nproperty short s\n"),
            std::string::npos)
      << after.header;
  constexpr std::size_t kRecord = 12 + 1 + 8 + 2;
  for (std::size_t i = 0; i < after.vertices.size(); ++i) {
    const char* const record = bytes.data() + after.header.size() + i * kRecord;
    double q = 0;
    std::int16_t s = 0;
    std::memcpy(&q, record + 13, 8);
    std::memcpy(&s, record + 21, 2);
    EXPECT_NEAR(q, 7.1, 1e-12) << i;
    EXPECT_EQ(s, -5) << i;
    EXPECT_GE(static_cast<unsigned char>(record[12]), 100) << i;
    EXPECT_LT(static_cast<unsigned char>(record[12]), 200) << i;
  }
  expect_success(reeb({"repair", "b.ply", "--apply-undo", "u", "-o", "c.ply", "--quiet"}));
  EXPECT_TRUE(ply("c.ply").vertices == torus.vertices);
  EXPECT_TRUE(ply("c.ply").triangles == torus.triangles);
  // Other formats.
  expect_success(reeb({"repair", "a.ply", "-o", "b.obj", "--all", "--quiet"}));
  expect_success(reeb({"convert", "b.obj", "b2.ply", "--quiet"}));
  EXPECT_TRUE(ply("b2.ply").triangles == after.triangles);
}

// A thin tube through a thick block: its triangles are far longer than the curve's edges, so the first patch is too
// small.
TEST_F(RepairTest, LooksAgainWhereAPatchEndsAtItsCurve) {
  constexpr std::size_t kAround = 24;
  const std::vector<std::array<double, 2>> profile = {{0.05, 0}, {0.05, 10}, {0.3, 10}, {10, 10}, {10, 0}, {0.3, 0}};
  PlainSurface block;
  for (const auto& [radius, height] : profile)
    for (std::size_t k = 0; k < kAround; ++k) {
      const double angle = 2 * 3.14159265358979 * static_cast<double>(k) / kAround;
      block.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
    }
  for (std::size_t i = 0; i < profile.size(); ++i)
    for (std::size_t k = 0; k < kAround; ++k) {
      const auto at = [&](std::size_t ring, std::size_t place) {
        return static_cast<std::uint32_t>(ring % profile.size() * kAround + place % kAround);
      };
      block.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      block.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  ASSERT_EQ(recount(block).genus(), 1);
  write("m.off", to_off(block));
  expect_success(reeb({"repair", "m.off", "-o", "r.ply", "--all", "--quiet", "--log", "r.json"}));
  EXPECT_EQ(json("r.json")["repaired"], 1) << file("r.json");
  const SurfaceCount count = recount(ply("r.ply"));
  EXPECT_EQ(count.genus(), 0);
  EXPECT_TRUE(count.is_closed_manifold());
}

// The hole of a thick ring, and a needle whose four corners are far away from it: through the hole, or beside the ring.
TEST_F(RepairTest, LeavesAHoleThatAHugeTrianglePassesThrough) {
  constexpr std::uint32_t kAround = 48, kAcross = 40;
  PlainSurface ring;
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double u = 2 * 3.14159265358979 * i / kAround, w = 2 * 3.14159265358979 * j / kAcross;
      const double r = 3 + 2.4 * std::cos(w);
      ring.vertices.push_back({r * std::cos(u), r * std::sin(u), 2.4 * std::sin(w)});
    }
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const auto at = [&](std::uint32_t k, std::uint32_t l) { return k % kAround * kAcross + l % kAcross; };
      ring.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      ring.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const std::uint32_t base = kAround * kAcross;
  for (const double away : {0.0, 12.0}) {
    PlainSurface both = ring;
    for (const auto& p : std::vector<std::array<double, 3>>{{0.1, 0, -90}, {-0.1, 0.1, -90}, {-0.1, -0.1, -90}})
      both.vertices.push_back({p[0] + away, p[1], p[2]});
    both.vertices.push_back({away, 0, 90});
    for (const auto& t : std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
      both.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    ASSERT_TRUE(recount(both).is_closed_manifold());
    // One format that can be looked up, and one that cannot.
    write("n.off", to_off(both));
    expect_success(reeb({"convert", "n.off", "n.ply", "--force", "--quiet"}));
    for (const std::string name : {"n.off", "n.ply"}) {
      expect_success(reeb({"repair", name, "-o", "r.ply", "--all", "--quiet", "--log", "r.json", "--force"}));
      const auto log = json("r.json");
      EXPECT_EQ(log["repaired"], away > 0 ? 1 : 0) << name;
      EXPECT_EQ(recount(ply("r.ply")).genus(), away > 0 ? 0 : 1) << name;
      if (away == 0) {
        EXPECT_EQ(log["left"][0]["why"], "every filling would cross the surface");
      }
    }
  }
}

TEST_F(RepairTest, KeepsTheSignOfZeros) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  PlainSurface torus = read_plain_ply(file("t.ply"));
  std::size_t zeros = 0;
  for (std::size_t i = 0; i < torus.vertices.size(); i += 7, ++zeros) torus.vertices[i][2] = -0.0;
  const auto count = [](const PlainSurface& surface) {
    std::size_t found = 0;
    for (const auto& p : surface.vertices) found += p[2] == 0 && std::signbit(p[2]) ? 1u : 0u;
    return found;
  };
  std::ostringstream text, object;
  text << "ply\nformat ascii 1.0\nelement vertex " << torus.vertices.size()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << torus.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& p : torus.vertices) {
    text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    object << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  for (const auto& t : torus.triangles) {
    text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    object << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  write("a.ply", text.str());
  write("a.obj", object.str());
  write("a.off", to_off(torus));
  std::string from = "a.ply";
  for (const std::string to : {"b.ply", "b.obj", "b.off", "c.ply"}) {
    expect_success(reeb({"repair", from, "-o", to, "--quiet", "--longest", "0"}));
    from = to;
  }
  EXPECT_EQ(count(ply("b.ply")), zeros);
  EXPECT_EQ(count(ply("c.ply")), zeros);
  for (const std::string other : {"a.obj", "a.off"}) {
    expect_success(reeb({"repair", other, "-o", "d.ply", "--quiet", "--longest", "0", "--force"}));
    EXPECT_EQ(count(ply("d.ply")), zeros) << other;
  }
  // New meshes have no -0.
  expect_success(reeb({"convert", "b.ply", "e.ply", "--quiet"}));
  EXPECT_EQ(count(ply("e.ply")), 0u);
}

TEST_F(RepairTest, SaysWhatIsOdd) {
  const auto says = [&](const std::vector<std::string>& options, const std::string& text) {
    std::vector<std::string> words = {"repair", "a.off", "-o", "b.ply", "--force"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = reeb(words);
    expect_success(outcome);
    EXPECT_NE(outcome.error.find(text), std::string::npos) << outcome.error;
  };
  write("a.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n");
  says({}, "note: the mesh has no triangles\n");
  EXPECT_EQ(reeb({"compute", "a.off"}).error.find("genus"), std::string::npos);
  write("a.off", "OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 3 3\n3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n");
  says({"--drop-components", "1%"}, "no component dropped; 1 isolated vertex stays\n");
  // Two squares with a seam between them. Any filling would lie on them.
  write("a.off",
        "OFF\n8 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 0\n2 0 0\n2 1 0\n1 1 0\n3 0 1 2\n3 0 2 3\n3 4 5 6\n3 4 6 7\n");
  says({"--fill-boundaries", "100"}, "note: 4 vertices of boundaries have the coordinates of another one");
  expect_success(reeb({"generate", "torus", "--triangles", "1k", "-o", "a.off", "--force"}));
  says({"--longest", "100"}, "note: --longest 100 is more than the whole mesh (");
}

TEST_F(RepairTest, SaysWhatAnObjFileLoses) {
  write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
  const Outcome outcome = reeb({"repair", "a.obj", "-o", "b.obj", "--drop-degenerate"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("not kept from the OBJ file: normals, colours\n"), std::string::npos) << outcome.error;
  EXPECT_EQ(file("b.obj").find("vn"), std::string::npos);
  const Outcome again = reeb({"repair", "b.obj", "-o", "c.obj", "--drop-degenerate"});
  expect_success(again);
  EXPECT_EQ(again.error.find("not kept"), std::string::npos) << again.error;
}

TEST_F(RepairTest, LeavesNothingHalfWrittenWhenItIsKilled) {
  expect_success(reeb({"generate", "scan", "--triangles", "30k", "-o", "s.ply"}));
  const std::vector<std::string> words = {"repair", "s.ply",  "-o",     "r.ply",   "--all",  "--log",
                                          "r.json", "--undo", "r.undo", "--force", "--quiet"};
  const Outcome whole = reeb(words);
  expect_success(whole);
  const std::vector<std::string> names = {"r.ply", "r.json", "r.undo"};
  std::vector<std::string> bytes;
  for (const std::string& name : names) bytes.push_back(file(name));
  std::size_t killed = 0;
  constexpr int kMoments = 12;
  for (int k = 1; k <= kMoments; ++k) {
    for (const std::string& name : names) std::filesystem::remove(in_folder(name));
    Command command;
    command.wrapper = {"timeout", "-s", "KILL", std::to_string(whole.seconds * k / kMoments)};
    killed += reeb(words, command).exit_code == 0 ? 0u : 1u;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!std::filesystem::exists(in_folder(names[i]))) continue;
      EXPECT_TRUE(file(names[i]) == bytes[i]) << names[i];
    }
    // Whoever has the mesh has the rest.
    EXPECT_TRUE(!std::filesystem::exists(in_folder("r.ply")) || std::filesystem::exists(in_folder("r.undo")));
  }
  EXPECT_GE(killed, 3u);
  expect_success(reeb(words));
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_TRUE(file(names[i]) == bytes[i]) << names[i];
}

TEST_F(RepairTest, SaysWhyLoopsAreLeft) {
  expect_success(reeb({"generate", "plate", "--triangles", "10k", "-o", "p.ply"}));
  const Outcome limited = reeb({"repair", "p.ply", "-o", "a.ply", "--all", "--limit", "1"});
  expect_success(limited);
  EXPECT_NE(limited.error.find(" left: beyond --limit\n"), std::string::npos) << limited.error;
  EXPECT_EQ(limited.error.find("second repair"), std::string::npos) << "nothing was in the way of the others";
  const Outcome none = reeb({"repair", "p.ply", "-o", "b.ply", "--below", "0%"});
  expect_success(none);
  EXPECT_NE(none.error.find(" left: persistence not below 0%\n"), std::string::npos) << none.error;
}

TEST_F(RepairTest, BoundariesAreChargedToTheMemory) {
  std::ostringstream vertices, triangles;
  constexpr int kTriangles = 100'000;
  for (int i = 0; i < kTriangles; ++i) {
    vertices << i << " 0 0\n" << i << " 0.5 0\n" << i << " 0 0.5\n";
    triangles << "3 " << 3 * i << ' ' << 3 * i + 1 << ' ' << 3 * i + 2 << '\n';
  }
  write("apart.off", "OFF\n" + std::to_string(3 * kTriangles) + ' ' + std::to_string(kTriangles) + " 0\n" +
                         vertices.str() + triangles.str());
  expect_error(reeb({"repair", "apart.off", "-o", "o.ply", "--fill-boundaries", "0.001", "--memory", "41M", "--quiet"}),
               3, "paths of boundaries needs ");
}

// The output has a third coordinate, which the mesh has not.
TEST_F(RepairTest, UndoesAMeshWithTwoCoordinates) {
  const std::string points = "0 0 1\n7 7 2\n1 0 3\n0 1 4\n";
  write("m.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n" + points +
                      "Triangles\n3\n1 3 4 1\n1 3 4 1\n2 2 2 1\nEnd\n");
  write("m.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty float q\n"
        "element face 3\nproperty list uchar int vertex_index\nend_header\n" +
            points + "3 0 2 3\n3 0 2 3\n3 1 1 1\n");
  write("m.cx", "v 0 0\nv 7 7\nv 1 0\nv 0 1\ns 0 2 3\ns 0 2 3\ns 1 1 1\n");
  for (const std::string mesh : {"m.mesh", "m.ply", "m.cx"})
    for (const std::string suffix : {".ply", ".obj", ".off"}) {
      SCOPED_TRACE(mesh + " to " + suffix);
      expect_success(reeb({"repair", mesh, "-o", "r" + suffix, "--drop-duplicates", "--drop-degenerate", "--undo", "u",
                           "--force", "--quiet"}));
      expect_success(reeb({"repair", "r" + suffix, "--apply-undo", "u", "-o", "b" + suffix, "--force", "--quiet"}));
      expect_success(reeb({"convert", "b" + suffix, "c.obj", "--force", "--quiet"}));
      expect_success(reeb({"convert", mesh, "d.obj", "--force", "--quiet"}));
      EXPECT_EQ(file("c.obj"), file("d.obj"));
    }
}

TEST_F(RepairTest, RefusesWhatItCannotDo) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  expect_success(reeb({"repair", "t.ply", "-o", "o.ply", "--all", "--undo", "o.undo", "--log", "o.json", "--quiet"}));
  EXPECT_EQ(recount(ply("o.ply")).genus(), 0);
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "o.ply"}).exit_code, 1);
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "t.ply", "--force"}).exit_code, 1);
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "p.xyz"}).exit_code, 2);
  for (const std::string share : {"5", "0.5%x", "101%"})
    expect_error(reeb({"repair", "t.ply", "-o", "p.ply", "--drop-components", share}), 2,
                 "--drop-components: \"" + share + "\" is not a share");
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "p.ply", "--fill-boundaries", "x"}).exit_code, 2);
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "p.ply", "--longest", "1%"}).exit_code, 2);
  for (const char* length : {"-1", "x", "3%"}) {
    const Outcome outcome = reeb({"repair", "t.ply", "-o", "p.ply", "--longest", length});
    expect_error(outcome, 2, "--longest: \"" + std::string(length) + "\" is not a length");
    EXPECT_EQ(lines_after("hint: ", outcome.error).at(0), "give it in the units of the mesh");
  }
  // They number vertices in another way, or hold float32 only.
  for (const char* output : {"p.sma", "p.events.txt", "p.cx"})
    expect_error(reeb({"repair", "t.ply", "-o", output}), 2, output);
  EXPECT_EQ(reeb({"repair", "-", "-o", "p.ply"}).exit_code, 2);
  // An undo file of another mesh, or of this one with another coordinate, or damaged.
  EXPECT_EQ(reeb({"repair", "t.ply", "--apply-undo", "o.undo", "-o", "p.ply"}).exit_code, 1);
  std::string moved = file("o.ply");
  moved[moved.find("end_header\n") + 11] ^= 1;
  write("moved.ply", moved);
  expect_error(reeb({"repair", "moved.ply", "--apply-undo", "o.undo", "-o", "p.ply"}), 1, "moved.ply: ");
  for (const std::string choice :
       {"--all", "--limit=3", "--drop-degenerate", "--drop-duplicates", "--below=1%", "--longest=1", "--loops=o.csv",
        "--drop-components=1%", "--fill-boundaries=1", "--log=l.json", "--undo=u"})
    expect_error(reeb({"repair", "o.ply", "--apply-undo", "o.undo", "-o", "p.ply", choice}), 2);
  std::string bytes = file("o.undo");
  for (std::size_t i = 0; i < bytes.size(); i += 1 + bytes.size() / 19) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 5);
    write("bad.undo", damaged);
    EXPECT_EQ(reeb({"repair", "o.ply", "--apply-undo", "bad.undo", "-o", "p.ply"}).exit_code, 1) << i;
  }
  write("bad.undo", bytes.substr(0, bytes.size() / 2));
  EXPECT_EQ(reeb({"repair", "o.ply", "--apply-undo", "bad.undo", "-o", "p.ply"}).exit_code, 1);
  // What is no undo file, or has more bytes than its arrays, is not read to its end.
  for (const std::string& begin : {std::string(), bytes}) {
    write("bad.undo", begin);
    std::filesystem::resize_file(in_folder("bad.undo"), std::uint64_t{1} << 31);
    const Outcome outcome = reeb({"repair", "o.ply", "--apply-undo", "bad.undo", "-o", "p.ply"});
    expect_error(outcome, 1, "bad.undo: ");
    if (!kSanitized) {
      EXPECT_LT(outcome.peak_rss_bytes, std::uint64_t{64} << 20);
    }
  }
  write("rows.csv", "rank,lo,hi,function\n1,0,1,x\n");
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "rows.csv"}).exit_code, 1);
  write("rows.csv", "rank,lo,hi,function\n1,0,99999999999999999999,x\n");
  const Outcome too_large = reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "rows.csv"});
  EXPECT_NE(too_large.error.find("rows.csv:2: this is not a row of a table of defects"), std::string::npos)
      << too_large.error;
  write("rows.csv", "rank,lo,hi,function\n" + std::string(65'536, '1') + "\n");
  expect_error(reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "rows.csv"}), 1, "rows.csv:2: this line is longer");
  expect_error(reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "/dev/zero"}), 1, "/dev/zero: ");
  write("rows.csv", "rank,lo,hi\n");
  EXPECT_EQ(reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "rows.csv"}).exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(in_folder("p.ply")));
  // Rows of a table.
  expect_success(reeb({"defects", "t.ply", "-o", "rows.csv", "--force", "--quiet"}));
  expect_success(reeb({"repair", "t.ply", "-o", "p.ply", "--loops", "rows.csv", "--quiet"}));
  EXPECT_TRUE(file("p.ply") == file("o.ply"));
}

}  // namespace
}  // namespace reeb::test
