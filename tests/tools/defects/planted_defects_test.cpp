// `reeb defects` on meshes with planted tunnels and bridges, whose place, length and kind are known.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "io/formats/open_mesh.h"
#include "tests/support/inputs/planted_mesh.h"
#include "tests/support/scratch.h"
#include "tests/tools/program.h"
#include "tools/defects/find_defects.h"
#include "tools/defects/surface_census.h"

namespace reeb::test {
namespace {

using tools::DefectRow;
using tools::Defects;
using tools::find_defects;
using tools::FindDefectsOptions;

struct Score {
  std::size_t planted = 0, found = 0, first_rows = 0, first_planted = 0;
  std::size_t right_kind = 0, right_length = 0, center_in_box = 0, meshes = 0, separated = 0;
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

// An edge of these meshes is about half a cell long; what is less than four edges wide may be missed.
bool counts(const Planted& defect) { return 2 * defect.radius >= 4 * 0.5; }

void judge(const PlantedMesh& mesh, const Defects& defects, std::uint64_t seed, Score& score) {
  const auto& rows = defects.table.rows;
  std::ostringstream misses;
  const auto text = [](const DefectRow& row) {
    std::ostringstream out;
    out << name_of(row.kind) << " at " << row.curve.place.center[0] << ' ' << row.curve.place.center[1] << ' '
        << row.curve.place.center[2] << ", contour " << row.length_contour << ", cycle " << row.length_cycle;
    return out.str();
  };
  if (rows.size() != genus(mesh)) misses << rows.size() << " rows of " << genus(mesh) << " loops\n";
  std::vector<bool> taken(mesh.planted.size(), false);
  double longest_planted = 0, shortest_other = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DefectRow& row = rows[i];
    const Point& center = row.curve.place.center;
    const bool first = i < taken.size();
    if (first) ++score.first_rows;
    std::size_t found = 0;
    while (found < taken.size() && (taken[found] || !is_at(mesh.planted[found], center))) ++found;
    if (found == taken.size()) {
      shortest_other = std::min(shortest_other, row.length());
      if (first) misses << "row " << i + 1 << " is not planted: " << text(row) << '\n';
      continue;
    }
    taken[found] = true;
    longest_planted = std::max(longest_planted, row.length());
    if (!first) {
      taken[found] = false;
      continue;
    }
    ++score.first_planted;
    const Planted& defect = mesh.planted[found];
    if (!counts(defect)) continue;
    ++score.found;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && row.curve.place.box[0][k] <= center[k] && center[k] <= row.curve.place.box[1][k];
    const bool kind = row.kind == (defect.tunnel ? DefectKind::kTunnel : DefectKind::kHandle);
    const bool close = std::abs(row.length() - defect.length()) <= 0.2 * defect.length();
    if (inside) ++score.center_in_box;
    if (kind) ++score.right_kind;
    if (close) ++score.right_length;
    if (!kind || !close || !inside)
      misses << "radius " << defect.radius << ", length " << defect.length() << " is " << text(row) << '\n';
  }
  for (std::size_t d = 0; d < taken.size(); ++d) {
    if (counts(mesh.planted[d])) ++score.planted;
    if (!taken[d]) misses << "not found: radius " << mesh.planted[d].radius << '\n';
  }
  const SuggestedLength& suggested = defects.table.suggestion;
  const bool separated = suggested.length && longest_planted <= *suggested.length && *suggested.length < shortest_other;
  ++score.meshes;
  if (separated) ++score.separated;
  if (!separated)
    misses << "suggested " << suggested.length.value_or(0) << ", longest planted " << longest_planted
           << ", shortest other " << shortest_other << '\n';
  if (const std::string told = misses.str(); !told.empty()) score.misses << "seed " << seed << ":\n" << told;
}

PlantedOptions planted_options(std::uint64_t seed) {
  PlantedOptions options;
  options.seed = seed;
  options.noise = std::array{0.0, 0.04, 0.1}[seed % 3];
  options.inwards = seed % 4 == 2;
  return options;
}

// `functions`: whose graphs are computed first; none: those of the coordinates.
Defects defects_of(const PlantedMesh& mesh, const std::string& folder, const std::vector<std::string>& functions = {}) {
  FindDefectsOptions options;
  options.mesh.path = folder + "/m.ply";
  options.mesh.temp_folder = folder;
  options.threads = 1;
  write_file(options.mesh.path, to_ply(mesh));
  for (std::size_t i = 0; i < functions.size(); ++i)
    options.files.push_back(folder + "/" + std::to_string(i) + ".reeb");
  if (!functions.empty()) compute(options.mesh.path, functions, options.files, {.threads = 1, .replace = true});
  return find_defects(options);
}

// How many of the planted defects have a row of their kind there.
std::size_t right_kinds(const PlantedMesh& mesh, const Defects& defects) {
  std::size_t right = 0;
  for (const Planted& planted : mesh.planted)
    for (const DefectRow& row : defects.table.rows)
      if (row.kind == (planted.tunnel ? DefectKind::kTunnel : DefectKind::kHandle) &&
          is_at(planted, row.curve.place.center) &&
          std::abs(row.length() - planted.length()) <= 0.2 * planted.length()) {
        ++right;
        break;
      }
  return right;
}

using PlantedDefects = ProgramTest;

TEST_F(PlantedDefects, AreListedFirstWithTheirKindAndLength) {
  const std::uint64_t meshes = std::getenv("REEB_TEST_ALL") != nullptr ? 200 : 9;
  Score score;
  std::atomic<std::uint64_t> next = 1;
  std::mutex one_at_a_time;
  const auto work = [&] {
    const ooc::Scratch folder;
    for (std::uint64_t seed = next++; seed <= meshes; seed = next++) {
      const PlantedMesh mesh = planted_mesh(planted_options(seed));
      const Defects defects = defects_of(mesh, folder.path());
      const std::scoped_lock lock(one_at_a_time);
      judge(mesh, defects, seed, score);
    }
  };
  {
    const std::jthread other(work);
    work();
  }
  const std::string misses = score.misses.str();
  std::printf("%s", misses.c_str());
  const auto share = [](std::size_t part, std::size_t of) {
    return static_cast<double>(part) / static_cast<double>(of);
  };
  std::printf(
      "%zu of %zu found, %zu of the first %zu rows planted, %zu kinds and %zu lengths right; %zu of %zu meshes "
      "separated\n",
      score.found, score.planted, score.first_planted, score.first_rows, score.right_kind, score.right_length,
      score.separated, score.meshes);
  EXPECT_GE(share(score.found, score.planted), 0.99);
  EXPECT_GE(share(score.first_planted, score.first_rows), 0.99);
  EXPECT_GE(share(score.right_kind, score.found), 0.99);
  EXPECT_EQ(score.center_in_box, score.found);
  EXPECT_GE(share(score.right_length, score.found), 0.99);
  EXPECT_GE(share(score.separated, score.meshes), 0.95);
}

// Bars and holes in two components, of which the second one is oriented inwards.
PlantedMesh two_components() {
  PlantedOptions options;
  options.seed = 5;
  options.least_radius = 1;
  PlantedMesh mesh = planted_mesh(options);
  options.seed = 6;
  options.inwards = true;
  PlantedMesh other = planted_mesh(options);
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  for (Vector& p : other.vertices) p[1] += 100;
  for (auto& t : other.triangles)
    for (std::uint32_t& corner : t) corner += shift;
  for (Planted& planted : other.planted) {
    planted.from[1] += 100;
    planted.to[1] += 100;
  }
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  mesh.triangles.insert(mesh.triangles.end(), other.triangles.begin(), other.triangles.end());
  mesh.planted.insert(mesh.planted.end(), other.planted.begin(), other.planted.end());
  return mesh;
}

TEST_F(PlantedDefects, EachComponentHasItsOrientation) {
  const PlantedMesh mesh = two_components();
  ASSERT_GE(mesh.planted.size(), 3u);
  // Without a coordinate among the functions, the tops of components must be found first.
  for (const std::vector<std::string>& functions : {std::vector<std::string>{}, {"distance:3,4,5", "distance:9,-50,0"}})
    EXPECT_EQ(right_kinds(mesh, defects_of(mesh, folder(), functions)), mesh.planted.size()) << functions.size();
}

TEST_F(PlantedDefects, KeepTheirKindFarFromBoundaries) {
  PlantedOptions options;
  options.seed = 4;
  options.least_radius = 1;
  PlantedMesh mesh = planted_mesh(options);
  // The triangles of a vertex that is far from all defects.
  const auto distance_to = [&](const Vector& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Planted& planted : mesh.planted) least = std::min(least, distance(p, planted.from));
    return least;
  };
  const auto far =
      static_cast<std::uint32_t>(std::ranges::max_element(mesh.vertices, {}, distance_to) - mesh.vertices.begin());
  ASSERT_GT(std::erase_if(mesh.triangles, [&](const auto& t) { return std::ranges::count(t, far) != 0; }), 2u);
  EXPECT_EQ(right_kinds(mesh, defects_of(mesh, folder())), mesh.planted.size());
}

// A torus of radii 3 and 1; vertex (ring, side) is ring * 24 + side.
PlantedMesh plain_torus() {
  PlantedMesh mesh;
  for (std::uint32_t i = 0; i < 60; ++i)
    for (std::uint32_t j = 0; j < 24; ++j) {
      const double a = 2 * 3.14159265358979 * i / 60, b = 2 * 3.14159265358979 * j / 24, r = 3 + std::cos(b);
      mesh.vertices.push_back({r * std::cos(a), 0.3 * r * std::sin(a) + std::sin(b), r * std::sin(a)});
      const std::uint32_t right = (i + 1) % 60 * 24, up = (j + 1) % 24, here = i * 24;
      mesh.triangles.push_back({here + j, here + up, right + j});
      mesh.triangles.push_back({right + j, here + up, right + up});
    }
  return mesh;
}

TEST_F(PlantedDefects, AreUnclearWhereCurvesMeetABoundary) {
  // Without a strip all the way round, every circle around the tube ends, and the others are around a boundary.
  PlantedMesh mesh = plain_torus();
  std::erase_if(mesh.triangles, [](const auto& t) {
    return std::ranges::all_of(t, [](std::uint32_t v) { return v % 24 == 5 || v % 24 == 6; });
  });
  const Defects defects = defects_of(mesh, folder());
  ASSERT_FALSE(defects.table.rows.empty());
  for (const DefectRow& row : defects.table.rows) EXPECT_EQ(row.kind, DefectKind::kUnclear);
}

TEST_F(PlantedDefects, AreNoHandlesWhereTheSurfaceIsNoManifold) {
  // A fin all the way round, outside: every circle around the tube meets it. The circle around the middle does not.
  PlantedMesh mesh = plain_torus();
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::uint32_t a = i * 24, b = (i + 1) % 60 * 24;
    Vector tip{};
    for (std::size_t k = 0; k < 3; ++k) tip[k] = 0.6 * (mesh.vertices[a][k] + mesh.vertices[b][k]);
    mesh.triangles.push_back({a, b, static_cast<std::uint32_t>(mesh.vertices.size())});
    mesh.vertices.push_back(tip);
  }
  const Defects defects = defects_of(mesh, folder());
  ASSERT_FALSE(defects.table.rows.empty());
  for (const DefectRow& row : defects.table.rows) EXPECT_NE(row.kind, DefectKind::kHandle);
}

// A torus of radii 3 and 0.6 about the axis z, then turned by the seed.
PlantedMesh small_torus(std::uint32_t around, std::uint32_t across, std::uint64_t seed, bool inwards) {
  PlantedMesh mesh;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  std::array<double, 3> turn{};
  if (seed != 0)
    for (double& t : turn) t = angle(random);
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across,
                   r = 3 + 0.6 * std::cos(b);
      Vector p = {r * std::cos(a), r * std::sin(a), 0.6 * std::sin(b)};
      for (std::size_t k = 0; k < 3; ++k) {
        double &x = p[k], &y = p[(k + 1) % 3];
        const double c = std::cos(turn[k]), s = std::sin(turn[k]), turned = c * x - s * y;
        y = s * x + c * y;
        x = turned;
      }
      mesh.vertices.push_back(p);
      const std::uint32_t next = (i + 1) % around * across, here = i * across, up = (j + 1) % across;
      mesh.triangles.push_back({here + j, next + j, next + up});
      mesh.triangles.push_back({here + j, next + up, here + up});
    }
  if (inwards)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// A patch holds all of it, so no rim shows where its inside is.
TEST_F(PlantedDefects, SmallToriAreHandlesHoweverTheyAreTurned) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto around = static_cast<std::uint32_t>(9 + seed % 8), across = static_cast<std::uint32_t>(4 + seed % 5);
    const Defects defects = defects_of(small_torus(around, across, seed, seed % 2 == 1), folder());
    ASSERT_EQ(defects.table.rows.size(), 1u) << seed;
    EXPECT_EQ(defects.table.rows[0].kind, DefectKind::kHandle) << seed;
  }
}

// The patch holds all of the surface, which is closed but for one triangle. Where a curve meets the hole, it is
// unclear.
TEST_F(PlantedDefects, ASmallTorusWithAHoleIsAHandle) {
  int meshes = 0, handles = 0;
  for (const bool inwards : {false, true})
    for (std::size_t hole = 0; hole < 160; hole += 7) {
      PlantedMesh mesh = small_torus(10, 8, 0, inwards);
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(hole));
      const Defects defects = defects_of(mesh, folder());
      ASSERT_FALSE(defects.table.rows.empty()) << hole;
      for (const DefectRow& row : defects.table.rows) EXPECT_NE(row.kind, DefectKind::kTunnel) << inwards << hole;
      ++meshes;
      handles += std::ranges::count(defects.table.rows, DefectKind::kHandle, &DefectRow::kind) != 0 ? 1 : 0;
    }
  EXPECT_GT(2 * handles, meshes);
}

// The surface of those of 3 × 3 × 3 cubes for which is_full(place) is true.
template <class IsFull>
PlantedMesh surface_of_cubes(const IsFull& is_in) {
  PlantedMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> number;
  const auto is_full = [&](const std::array<int, 3>& c) {
    return std::ranges::all_of(c, [](int x) { return x >= 0 && x < 3; }) && is_in(c);
  };
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [it, is_new] = number.emplace(p, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back({p[0] + 0.01 * p[1], p[1] - 0.02 * p[2], p[2] + 0.03 * p[0]});
    return it->second;
  };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            std::array<int, 3> cube{i, j, k}, beside = cube;
            beside[axis] += 2 * side - 1;
            if (!is_full(cube) || is_full(beside)) continue;
            std::array<std::uint32_t, 4> corners{};
            for (std::size_t c = 0; c < 4; ++c) {
              std::array<int, 3> p = cube;
              p[axis] += side;
              p[(axis + 1) % 3] += c == 1 || c == 2 ? 1 : 0;
              p[(axis + 2) % 3] += c >= 2 ? 1 : 0;
              corners[c] = vertex(p);
            }
            if (side == 0) std::swap(corners[1], corners[3]);
            mesh.triangles.push_back({corners[0], corners[1], corners[2]});
            mesh.triangles.push_back({corners[0], corners[2], corners[3]});
          }
  return mesh;
}

// Its wall is an edge wide, so the triangles next to those at the hole are outside.
TEST_F(PlantedDefects, AHoleThroughAThinWallIsATunnel) {
  PlantedMesh mesh = surface_of_cubes([](const auto& c) { return c[2] < 2 && (c[0] != 1 || c[1] != 1); });
  for (const bool inwards : {false, true}) {
    if (inwards)
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    const Defects defects = defects_of(mesh, folder());
    ASSERT_EQ(defects.table.rows.size(), 1u);
    EXPECT_NEAR(defects.table.rows[0].length(), 4, 0.2);
    EXPECT_EQ(defects.table.rows[0].kind, DefectKind::kTunnel) << inwards;
  }
}

// Several loops of a coordinate have the same shortest curve. Each of the five has one of its own.
TEST_F(PlantedDefects, EachLoopOfTheEdgesOfACubeHasACurve) {
  const PlantedMesh mesh = surface_of_cubes([](const auto& c) { return std::ranges::count(c, 1) < 2; });
  ASSERT_EQ(genus(mesh), 5u);
  for (const std::vector<std::string>& functions : {std::vector<std::string>{}, {"x"}, {"distance:1,7,2"}}) {
    const Defects defects = defects_of(mesh, folder(), functions);
    ASSERT_EQ(defects.table.rows.size(), 5u);
    for (const DefectRow& row : defects.table.rows) {
      EXPECT_LE(row.length(), 8.5);
      EXPECT_FALSE(row.curve.path.empty());
      EXPECT_NE(row.kind, DefectKind::kUnclear);
    }
  }
  expect_success(reeb({"repair", "m.ply", "-o", "o.ply", "--all", "--quiet", "--log", "log.json"}));
  EXPECT_NE(file("log.json").find("\"repaired\": 5"), std::string::npos) << file("log.json");
}

// The highest vertices are a ring, and have no triangles of their own.
TEST_F(PlantedDefects, ATorusWithALevelTopHasItsOrientation) {
  for (const bool inwards : {false, true}) {
    const Defects defects = defects_of(small_torus(24, 12, 0, inwards), folder(), {"z", "x"});
    ASSERT_FALSE(defects.table.rows.empty());
    for (const DefectRow& row : defects.table.rows) EXPECT_EQ(row.kind, DefectKind::kHandle) << inwards;
  }
}

// The four nodes of the graph are nearly on a line, which says nothing about the lengths of edges.
TEST_F(PlantedDefects, AreFoundWithTheGraphOfOneCoordinate) {
  for (const std::string function : {"x", "y", "z"}) {
    const Defects defects = defects_of(small_torus(24, 12, 0, false), folder(), {function});
    ASSERT_FALSE(defects.table.rows.empty()) << function;
    const bool any = std::ranges::any_of(defects.table.rows, [](const DefectRow& row) {
      return row.kind == DefectKind::kHandle && std::abs(row.length() - 2 * std::numbers::pi * 0.6) < 0.2;
    });
    EXPECT_TRUE(any) << function;
  }
}

TEST_F(PlantedDefects, FoldersOfPatchesAreCheckedFirst) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  const Outcome missing = reeb({"defects", "t.ply", "--patches", "no/near", "--quiet"});
  expect_error(missing, 3, "no: this folder does not exist");
  EXPECT_NE(missing.error.find("--patches DIR"), std::string::npos) << missing.error;
  EXPECT_EQ(files(), std::vector<std::string>{"t.ply"});
  write("file", "");
  expect_error(reeb({"defects", "t.ply", "--patches", "file", "--quiet"}), 3);
  expect_success(reeb({"defects", "t.ply", "--patches", "near", "--quiet"}));
  expect_error(reeb({"defects", "t.ply", "--patches", "near", "--quiet"}), 1);
  expect_success(reeb({"defects", "t.ply", "--patches", "near", "--quiet", "--force"}));
  const Outcome said = reeb({"defects", "t.ply", "--patches", "near", "-o", "t.csv", "--force"});
  expect_success(said);
  EXPECT_EQ(lines_after("wrote ", said.error),
            (std::vector<std::string>{"near: surfaces and curves of 1 loop", "t.csv"}));
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

TEST_F(PlantedDefects, ALimitKeepsTheFirstRows) {
  expect_success(reeb({"generate", "plate", "--triangles", "2000", "-o", "p.ply"}));
  const Outcome all = reeb({"defects", "p.ply", "-o", "-", "--quiet"});
  expect_success(all);
  std::vector<std::string> rows = lines_after("", all.output);  // with the header
  ASSERT_GT(rows.size(), 4u);
  rows.resize(4);
  const Outcome limited = reeb({"defects", "p.ply", "-o", "-", "--quiet", "--limit", "3", "--patches", "near"});
  expect_success(limited);
  EXPECT_EQ(lines_after("", limited.output), rows);
  for (const int rank : {1, 2, 3, 4})
    EXPECT_EQ(std::filesystem::exists(in_folder("near/defect-" + std::to_string(rank) + ".ply")), rank <= 3) << rank;
}

// Squares of such lengths are beyond the doubles.
TEST_F(PlantedDefects, AreUnclearWhereLengthsCannotBeMeasured) {
  write("huge.obj", "v 0 0 0\nv 0 0 1e155\nv 1 0 1e154\nl 1 2\nl 2 3\nl 1 3\n");
  expect_success(reeb({"defects", "huge.obj", "-o", "huge.csv", "--patches", "patches"}));
  const std::string rows = file("huge.csv");
  EXPECT_NE(rows.find(",unclear,inf,inf,"), std::string::npos) << rows;
  expect_success(reeb({"repair", "huge.obj", "--all", "-o", "repaired.obj"}));
}

TEST_F(PlantedDefects, FilesOfAnotherMeshAreRefused) {
  expect_success(reeb({"generate", "torus", "--triangles", "2000", "-o", "t.ply"}));
  expect_success(reeb({"generate", "torus", "--triangles", "3000", "-o", "u.ply"}));
  expect_success(reeb({"compute", "u.ply", "--quiet"}));
  EXPECT_EQ(reeb({"defects", "t.ply", "u.reeb"}).exit_code, 1);
  EXPECT_EQ(reeb({"defects", "u.reeb"}).exit_code, 1);
  EXPECT_EQ(reeb({"defects", "-"}).exit_code, 2);
  expect_success(reeb({"defects", "u.ply", "u.reeb", "--quiet"}));
  // A triangle of the same vertices is missing, and no loop makes anyone look.
  const std::string whole = kSmallOff;
  write("whole.off", whole);
  write("open.off", "OFF\n4 3 0\n" + whole.substr(10, whole.rfind("3 0 3 2") - 10));
  expect_success(reeb({"compute", "whole.off", "--quiet"}));
  expect_error(reeb({"defects", "open.off", "whole.reeb"}), 1,
               "whole.reeb: this is not the graph of that mesh: it was computed from 4 triangles, the mesh has 3");
}

TEST_F(PlantedDefects, OfCellsAreRefused) {
  expect_success(reeb({"generate", "ball", "--tetrahedra", "300", "-o", "b.svb"}));
  expect_success(reeb({"compute", "b.svb", "--quiet"}));
  expect_error(reeb({"defects", "b.svb"}), 1, "b.svb: the mesh has cells, so it is not a surface");
  expect_error(reeb({"defects", "b.svb", "b.reeb"}), 1, "b.svb: the mesh has cells, so it is not a surface");
  expect_success(reeb({"generate", "volume", "--grid", "9x9x9", "--handles", "1", "-o", "v.nrrd"}));
  const Outcome image = reeb({"defects", "v.nrrd"});
  expect_error(image, 1, "v.nrrd: the mesh has cells, so it is not a surface");
  EXPECT_NE(image.error.find("hint: make an isosurface of the image"), std::string::npos) << image.error;
  write("one.off", kSmallOff);
  EXPECT_EQ(reeb({"defects", "one.off", "--quiet"}).output, "no loops in the graph of x: nothing to list\n");
}

// On a mesh that is looked up, and on one that is read as a stream.
TEST_F(PlantedDefects, TheirCensusIsInterruptedAtAnyTime) {
  expect_success(reeb({"generate", "torus", "--triangles", "200k", "-o", "t.ply"}));
  expect_success(reeb({"convert", "t.ply", "t.obj", "--quiet"}));
  for (const char* name : {"t.ply", "t.obj"}) {
    tools::MeshSource mesh{.path = in_folder(name), .format = "", .temp_folder = folder()};
    int asked = 0;
    mesh.interrupted = [&] { return ++asked < 0; };
    EXPECT_EQ(tools::census_of(mesh).components, 1u);
    EXPECT_GT(asked, 4) << name;
    for (const int when : {1, asked / 2, asked}) {
      int at = 0;
      try {
        mesh.interrupted = [&] { return ++at == when; };
        tools::census_of(mesh);
        ADD_FAILURE() << name << ' ' << when;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kInterrupted);
      }
    }
  }
}

// The components of triangles, where no path leads over these edges.
std::size_t pieces(const std::vector<std::array<std::uint64_t, 3>>& triangles,
                   const std::set<std::pair<std::uint64_t, std::uint64_t>>& cut) {
  std::vector<std::size_t> up(triangles.size());
  std::iota(up.begin(), up.end(), std::size_t{0});
  const auto top = [&up](std::size_t t) {
    while (up[t] != t) t = up[t] = up[up[t]];
    return t;
  };
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::size_t> of_edge;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair edge = std::minmax({triangles[t][k], triangles[t][(k + 1) % 3]});
      if (cut.contains(edge)) continue;
      const auto [other, is_new] = of_edge.emplace(edge, t);
      if (!is_new) up[top(t)] = top(other->second);
    }
  std::size_t count = 0;
  for (std::size_t t = 0; t < up.size(); ++t) count += up[t] == t ? 1u : 0u;
  return count;
}

// The isosurface of a random image, genus 15. The first row had a curve around a disc of 28 triangles.
TEST_F(PlantedDefects, NoCurveDividesTheSurface) {
  const std::string path = REEB_SOURCE_DIR "/tests/golden/defects/dividing_curve.off.gz";
  std::vector<std::array<std::uint64_t, 3>> triangles;
  const auto reader = io::open_mesh(path);
  for (MeshBatch batch; reader->read(batch);)
    for (std::size_t i = 0; i < batch.triangles().size(); i += 3)
      triangles.push_back(
          {batch.triangles()[i].value(), batch.triangles()[i + 1].value(), batch.triangles()[i + 2].value()});
  ASSERT_EQ(triangles.size(), 2720u);
  const std::size_t whole = pieces(triangles, {});
  FindDefectsOptions options;
  options.mesh.path = path;
  options.mesh.temp_folder = temp_folder();
  const Defects defects = find_defects(options);
  EXPECT_EQ(defects.table.rows.size(), 15u);
  for (const DefectRow& row : defects.table.rows) {
    std::set<std::pair<std::uint64_t, std::uint64_t>> edges;
    for (std::size_t i = 0; i < row.curve.path.size(); ++i)
      edges.insert(std::minmax({row.curve.path[i].value(), row.curve.path[(i + 1) % row.curve.path.size()].value()}));
    EXPECT_GE(edges.size(), 3u);
    EXPECT_EQ(pieces(triangles, edges), whole) << "a curve of length " << row.length();
  }
}

// A plate has so many holes that their patches meet.
TEST_F(PlantedDefects, RowsDoNotDependOnMemoryNorThreads) {
  expect_success(reeb({"generate", "plate", "--triangles", "20k", "-o", "p.ply"}));
  const auto rows = [&](const char* memory, const char* threads) {
    const Outcome outcome = reeb({"defects", "p.ply", "-o", "-", "--quiet", "--memory", memory, "--threads", threads});
    expect_success(outcome);
    return outcome.output;
  };
  const std::string expected = rows("1G", "1");
  EXPECT_GT(std::count(expected.begin(), expected.end(), '\n'), 200);
  EXPECT_EQ(rows("20M", "1"), expected);
  EXPECT_EQ(rows("20M", "3"), expected);
}

}  // namespace
}  // namespace reeb::test
