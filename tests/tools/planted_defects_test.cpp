// `reeb defects` on meshes with planted tunnels and bridges, whose place, length and kind are known.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/planted_mesh.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

struct Score {
  std::size_t planted = 0, listed = 0, right_kind = 0, right_length = 0, center_in_box = 0, meshes = 0, separated = 0;
  std::ostringstream misses;
};

// How far a point is from the axis, if it is beside it.
bool is_at(const Planted& defect, const Vector& p) {
  Vector axis{}, d{};
  double length = 0, along = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    axis[k] = defect.to[k] - defect.from[k];
    d[k] = p[k] - defect.from[k];
    length += axis[k] * axis[k];
    along += axis[k] * d[k];
  }
  along /= length;
  double side = 0;
  for (std::size_t k = 0; k < 3; ++k) side += std::pow(d[k] - along * axis[k], 2);
  return along > -0.1 && along < 1.1 && std::sqrt(side) < 0.6 * defect.radius + 1;
}

// Of a closed surface of one component: each edge is in two triangles.
std::size_t genus(const PlantedMesh& mesh) { return (2 + mesh.triangles.size() / 2 - mesh.vertices.size()) / 2; }

class PlantedDefects : public ProgramTest {
 protected:
  void look_at(const PlantedOptions& options, Score& score) {
    const PlantedMesh mesh = planted_mesh(options);
    write("m.off", to_off(mesh));
    expect_success(reeb({"defects", "m.off", "-o", "d.json", "--force", "--quiet"}));
    const auto json = nlohmann::json::parse(file("d.json"));
    const auto& loops = json["loops"];
    EXPECT_EQ(loops.size(), genus(mesh)) << options.seed;
    EXPECT_EQ(json["components"]["count"], 1);
    EXPECT_EQ(json["boundaries"]["count"], 0);
    ++score.meshes;
    std::vector<bool> taken(mesh.planted.size(), false);
    double longest_planted = 0, shortest_other = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const auto& row = loops[i];
      const double length = std::min(number(row["length_contour"]), number(row["length_cycle"]));
      const Vector center = {row["center_x"], row["center_y"], row["center_z"]};
      std::size_t found = taken.size();
      for (std::size_t d = 0; d < taken.size() && found == taken.size(); ++d)
        if (!taken[d] && is_at(mesh.planted[d], center)) found = d;
      if (found == taken.size()) {
        shortest_other = std::min(shortest_other, length);
        if (i < taken.size()) score.misses << options.seed << ": row " << row.dump() << '\n';
        continue;
      }
      taken[found] = true;
      longest_planted = std::max(longest_planted, length);
      if (i >= taken.size()) continue;
      ++score.listed;
      const Planted& defect = mesh.planted[found];
      bool inside = true;
      const char* axes[] = {"x", "y", "z"};
      for (std::size_t k = 0; k < 3; ++k)
        inside = inside && row[std::string("min_") + axes[k]] <= center[k] &&
                 center[k] <= row[std::string("max_") + axes[k]];
      score.center_in_box += inside ? 1 : 0;
      const bool kind = row["kind"] == (defect.tunnel ? "tunnel" : "handle");
      const bool close = std::abs(length - defect.length()) <= 0.2 * defect.length();
      score.right_kind += kind ? 1 : 0;
      score.right_length += close ? 1 : 0;
      if (!kind || !close || !inside)
        score.misses << options.seed << ": radius " << defect.radius << ", length " << defect.length() << " is "
                     << row.dump() << '\n';
    }
    score.planted += taken.size();
    for (std::size_t d = 0; d < taken.size(); ++d)
      if (!taken[d]) score.misses << options.seed << ": not listed: radius " << mesh.planted[d].radius << '\n';
    const auto& suggested = json["suggested_threshold"]["length"];
    const bool separated =
        suggested.is_number() && longest_planted <= double(suggested) && double(suggested) < shortest_other;
    score.separated += separated ? 1 : 0;
    if (!separated)
      score.misses << options.seed << ": suggested " << json["suggested_threshold"].dump() << ", longest planted "
                   << longest_planted << ", shortest other " << shortest_other << '\n';
  }

 private:
  static double number(const nlohmann::json& value) {
    return value.is_string() ? std::numeric_limits<double>::infinity() : double(value);
  }
};

TEST_F(PlantedDefects, AreListedFirstWithTheirKindAndLength) {
  const std::size_t meshes = std::getenv("REEB_TEST_ALL") != nullptr ? 200 : 6;
  Score score;
  for (std::size_t i = 0; i < meshes; ++i) {
    PlantedOptions options;
    options.seed = i + 1;
    options.noise = i % 3 == 0 ? 0.05 : 0;
    options.inwards = i % 4 == 1;
    look_at(options, score);
  }
  SCOPED_TRACE(score.misses.str());
  const auto share = [](std::size_t part, std::size_t of) {
    return static_cast<double>(part) / static_cast<double>(of);
  };
  // Of 160 defects in 60 meshes 3 are missed: a curve of which the other one leaves the patch can be a wrong one.
  EXPECT_GE(share(score.listed, score.planted), 0.97);
  EXPECT_GE(share(score.right_kind, score.listed), 0.99);
  EXPECT_EQ(score.center_in_box, score.listed);
  EXPECT_GE(share(score.right_length, score.listed), 0.99);
  EXPECT_GE(share(score.separated, score.meshes), 0.95);
}

TEST_F(PlantedDefects, OptionsChooseRowsAndWritePatches) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  expect_success(reeb({"defects", "t.ply", "-o", "t.csv", "--patches", "near", "--quiet"}));
  const std::string header =
      "rank,lo,hi,persistence,persistence_percent,center_x,center_y,center_z,min_x,min_y,min_z,max_x,max_y,max_z,"
      "kind,length_contour,length_cycle,triangles,function\n";
  const std::string csv = file("t.csv");
  EXPECT_EQ(csv.substr(0, header.size()), header);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
  EXPECT_NE(csv.find(",handle,"), std::string::npos) << csv;
  EXPECT_NE(file("near/defect-1.ply").find("element vertex"), std::string::npos);
  EXPECT_NE(file("near/defect-1-curves.ply").find("element edge"), std::string::npos);
  for (const std::vector<std::string>& filter :
       {std::vector<std::string>{"--longest", "3"}, {"--below", "1%"}, {"--below", "0.5"}}) {
    std::vector<std::string> words = {"defects", "t.ply", "-o", "-", "--quiet"};
    words.insert(words.end(), filter.begin(), filter.end());
    EXPECT_EQ(reeb(words).output, header) << filter[0] << ' ' << filter[1];
  }
}

TEST_F(PlantedDefects, FilesOfAnotherMeshAreRefused) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  expect_success(reeb({"generate", "torus", "--triangles", "3000", "-o", "u.ply"}));
  expect_success(reeb({"compute", "u.ply", "--quiet"}));
  EXPECT_EQ(reeb({"defects", "t.ply", "u.reeb"}).exit_code, 1);
  EXPECT_EQ(reeb({"defects", "u.reeb"}).exit_code, 1);
  EXPECT_EQ(reeb({"defects", "-"}).exit_code, 2);
  expect_success(reeb({"defects", "u.ply", "u.reeb", "--quiet"}));
}

}  // namespace
}  // namespace reeb::test
