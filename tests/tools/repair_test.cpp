// `reeb repair` on meshes with planted tunnels and bridges; counted again by plain code.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/plain_surface.h"
#include "tests/support/planted_mesh.h"
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
};

TEST_F(RepairTest, CutsPlantedDefectsAndNothingElse) {
  const bool all = std::getenv("REEB_TEST_ALL") != nullptr;
  const std::size_t meshes = all ? 60 : 5;
  std::size_t planted = 0, repaired = 0;
  std::string misses;
  for (std::size_t seed = 1; seed <= meshes; ++seed) {
    PlantedOptions options;
    options.seed = seed;
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

    expect_success(reeb({"repair", "r.ply", "--apply-undo", "r.undo", "-o", "b.ply", "--force", "--quiet"}));
    const PlainSurface back = ply("b.ply");
    EXPECT_EQ(back.vertices, before.vertices) << seed;
    EXPECT_EQ(back.triangles, before.triangles) << seed;
  }
  EXPECT_GE(static_cast<double>(repaired), 0.97 * static_cast<double>(planted)) << misses;
  if (all) std::fprintf(stderr, "%zu of %zu planted repaired\n%s", repaired, planted, misses.c_str());
}

}  // namespace
}  // namespace reeb::test
