// Meshes of other projects' test suites, where their packages are installed (Debian: assimp-testmodels, libcgal-demo):
// each is read with the counts that a second, slow reader finds, or is refused with a message.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "io/formats/open_mesh.h"
#include "libreeb/base/error.h"
#include "tests/io/formats/mesh_files.h"
#include "tests/support/files.h"

namespace reeb::io::testing {
namespace {

namespace fs = std::filesystem;

struct Counts {
  std::uint64_t vertices = 0, polygons = 0;
  friend bool operator==(const Counts&, const Counts&) = default;
};

// OBJ and OFF: a line of words each. Nothing if the file is not of this simple form.
std::optional<Counts> count_obj(const std::string& text) {
  Counts counts;
  std::istringstream lines(text);
  bool continued = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (!continued && words >> word) {
      counts.vertices += word == "v" ? 1u : 0u;
      if (word == "l") return std::nullopt;
      counts.polygons += word == "f" ? 1u : 0u;
    }
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    continued = line.ends_with('\\') && line.find('#') == std::string::npos;
  }
  return counts;
}

std::optional<Counts> count_off(const std::string& text) {
  std::string kept;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) kept += line.substr(0, line.find('#')) + "\n";
  std::istringstream words(kept);
  std::string word;
  Counts counts;
  words >> word;
  if (word.find("OFF") == std::string::npos || word.starts_with('n')) return std::nullopt;
  if (!(words >> counts.vertices >> counts.polygons)) return std::nullopt;
  return counts;
}

std::optional<Counts> count_ply(const std::string& text) {
  Counts counts;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && !line.starts_with("end_header");) {
    std::istringstream words(line);
    std::string word, name;
    std::uint64_t count = 0;
    if (!(words >> word >> name >> count) || word != "element") continue;
    if (name == "tristrips") return std::nullopt;
    if (name == "vertex") counts.vertices = count;
    if (name == "face") counts.polygons = count;
  }
  return counts;
}

std::optional<Counts> count_stl(const std::string& bytes) {
  std::uint32_t facets = 0;
  if (bytes.size() >= 84) std::memcpy(&facets, bytes.data() + 80, 4);
  std::set<std::vector<double>> points;
  Counts counts;
  if (bytes.size() == 84 + std::uint64_t{50} * facets) {
    counts.polygons = facets;
    for (std::size_t f = 0; f < facets; ++f)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        float xyz[3];
        std::memcpy(xyz, bytes.data() + 84 + 50 * f + 12 + 12 * corner, 12);
        points.insert({xyz[0] + 0.0, xyz[1] + 0.0, xyz[2] + 0.0});
      }
  } else {
    std::istringstream words(bytes);
    for (std::string word; words >> word;) {
      counts.polygons += word == "facet" ? 1u : 0u;
      if (word != "vertex") continue;
      std::string x, y, z;
      words >> x >> y >> z;
      points.insert({std::stod(x) + 0.0, std::stod(y) + 0.0, std::stod(z) + 0.0});
    }
  }
  counts.vertices = points.size();
  return counts;
}

std::optional<Counts> count_slowly(const fs::path& path) {
  const std::string bytes = test::read_file(path.string());
  std::string suffix = path.extension().string();
  std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".obj") return count_obj(bytes);
  if (suffix == ".off") return count_off(bytes);
  if (suffix == ".ply") return count_ply(bytes);
  return count_stl(bytes);
}

std::vector<fs::path> meshes_below(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::string suffix = entry.path().extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (entry.is_regular_file() && (suffix == ".obj" || suffix == ".off" || suffix == ".ply" || suffix == ".stl"))
      paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

// The files that are damaged, or are no meshes, with a part of what is said of them.
void expect_read_or_refused(const fs::path& folder, const std::map<std::string, std::string>& refused) {
  std::size_t read = 0, told = 0;
  for (const fs::path& path : meshes_below(folder)) {
    SCOPED_TRACE(path);
    const auto expected = refused.find(path.filename().string());
    try {
      const auto reader = open_mesh(path.string());
      Counts counts;
      MeshBatch batch;
      while (reader->read(batch)) counts.vertices += batch.vertex_count;
      EXPECT_EQ(expected, refused.end()) << "was read";
      const auto slow = count_slowly(path);
      if (slow) {
        EXPECT_EQ(counts.vertices, slow->vertices);
        EXPECT_EQ(reader->info().simplex_count.value_or(slow->polygons), slow->polygons);
      }
      ++read;
    } catch (const Error& error) {
      if (expected == refused.end())
        ADD_FAILURE() << error.what();
      else
        EXPECT_NE(std::string(error.what()).find(expected->second), std::string::npos) << error.what();
      EXPECT_FALSE(error.hint().empty());
      ++told;
    }
  }
  EXPECT_GT(read, 30u);
  EXPECT_EQ(told, refused.size());
}

TEST(InstalledMeshes, OfAssimp) {
  const fs::path folder = "/usr/share/assimp/models";
  if (!fs::exists(folder)) GTEST_SKIP() << "not here: the package assimp-testmodels is not installed";
  expect_read_or_refused(folder, {{"invalid.off", "names vertex 20"},
                                  {"empty.off", "is empty"},
                                  {"empty.ply", "is empty"},
                                  {"empty.obj", "is empty"},
                                  {"malformed.obj", "names vertex 12"},
                                  {"OutOfMemory.off", "announces 353,535,235,358 vertices"},
                                  {"pond.0.ply", "has room for"},
                                  {"issue623.ply", "a list length is not an integer"},
                                  {"number_formats.obj", "\"3.1+e2\" is not a number"},
                                  {"box_UTF16BE.obj", "UTF-16"}});
}

TEST(InstalledMeshes, OfCgal) {
  const fs::path archive = "/usr/share/doc/libcgal-dev/data.tar.gz";
  if (!fs::exists(archive)) GTEST_SKIP() << "not here: the package libcgal-demo is not installed";
  const fs::path folder = scratch_folder() / "cgal";
  fs::create_directories(folder);
  ASSERT_EQ(std::system(("tar -C '" + folder.string() + "' -xzf '" + archive.string() + "'").c_str()), 0);
  expect_read_or_refused(folder, {});
}

}  // namespace
}  // namespace reeb::io::testing
