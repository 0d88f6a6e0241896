// Images as a user meets them: as meshes that no file has.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/random.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class Image : public ProgramTest {
 protected:
  // Little-endian float32.
  void write_raw(const std::string& name, const std::vector<float>& values) const {
    std::string bytes;
    for (const float value : values) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (unsigned k = 0; k < 4; ++k) bytes += static_cast<char>(bits >> (8 * k) & 255);
    }
    write(name, bytes);
  }
  // Computes with these options and returns the graph as text.
  std::string graph_of(const std::string& mesh, std::vector<std::string> options) {
    options.insert(options.begin(), {"compute", mesh, "-o", "out.reeb", "--force", "--quiet"});
    expect_success(reeb(options));
    const Outcome graph = reeb({"extract", "out.reeb", "--format", "rg", "-o", "out.rg", "--force"});
    expect_success(graph);
    return file("out.rg");
  }
  std::uint64_t loops(const std::string& mesh, std::vector<std::string> options) {
    graph_of(mesh, std::move(options));
    return nlohmann::json::parse(reeb({"info", "out.reeb", "--json"}).output)["graph"]["loops"];
  }
};

const std::vector<std::string> kSmallGrid = {"--grid", "7x6x5", "--type", "f32le"};

TEST_F(Image, HasTheGraphOfItsTetrahedra) {
  Random random(1);
  std::vector<float> values(7 * 6 * 5);
  for (float& value : values) value = static_cast<float>(random.below(9));
  write_raw("v.raw", values);
  const std::string graph = graph_of("v.raw", kSmallGrid);
  EXPECT_NE(graph.find("\na "), std::string::npos);
  std::vector<std::string> convert = kSmallGrid;
  convert.insert(convert.begin(), {"convert", "v.raw", "v.sva"});
  expect_success(reeb(convert));
  EXPECT_EQ(graph_of("v.sva", {"-f", "property:s0"}), graph);
  for (const char* chunk : {"1", "30"}) {
    std::vector<std::string> options = kSmallGrid;
    options.insert(options.end(), {"--chunk", chunk, "--threads", "2", "-f", "property:value"});
    EXPECT_EQ(graph_of("v.raw", options), graph);
  }
}

TEST_F(Image, OfAGeneratedVolumeHasALoopForEachHandle) {
  expect_success(reeb({"generate", "volume", "--grid", "20x18x6", "--handles", "5", "-o", "v.nrrd"}));
  for (const char* function : {"value", "x"}) {
    EXPECT_EQ(loops("v.nrrd", {"--nodata", "skip", "-f", function}), 5u);
    expect_success(reeb({"verify", "out.reeb", "--mesh", "v.nrrd", "--nodata", "skip", "--full"}));
    EXPECT_EQ(loops("v.nrrd", {"-f", function}), 0u);
    expect_success(reeb({"verify", "out.reeb", "--mesh", "v.nrrd", "--full"}));
  }
  expect_success(reeb({"generate", "volume", "--grid", "20x18", "--handles", "3", "--seed", "4", "-o", "h.nrrd"}));
  EXPECT_EQ(loops("h.nrrd", {"--nodata", "skip"}), 3u);
  expect_error(reeb({"generate", "volume", "--grid", "9x9x9", "--handles", "10", "-o", "w.nrrd"}), 2);
  expect_error(reeb({"generate", "volume", "--handles", "1", "-o", "w.nrrd"}), 2);
  expect_error(reeb({"generate", "torus", "--handles", "1", "-o", "w.ply"}), 2);
  expect_error(reeb({"generate", "volume", "--grid", "9x9x9", "-o", "w.ply"}), 2);
}

// A small image with some vertices without data. Returns the numbers of those that have data.
class ImageWithGaps : public Image {
 protected:
  std::vector<std::uint64_t> write_image(std::uint64_t seed) const {
    Random random(seed);
    const std::uint64_t x = 1 + random.below(6), y = 2 + random.below(5), z = 1 + random.below(4);
    std::string text = "NRRD0005\ntype: int\ndimension: 3\nsizes: " + std::to_string(x) + " " + std::to_string(y) +
                       " " + std::to_string(z) + "\nencoding: ascii\nnodata:=-9\n\n";
    std::vector<std::uint64_t> present;
    for (std::uint64_t v = 0; v < x * y * z; ++v) {
      const bool is_left_out = v != 1 && random.below(4) == 0;  // one is always there
      if (!is_left_out) present.push_back(v);
      text += is_left_out ? "-9\n" : std::to_string(random.below(7)) + "\n";
    }
    write("v.nrrd", text);
    return present;
  }
  std::string graph_of_image(const std::string& function) {
    return graph_of("v.nrrd", {"--nodata", "skip", "-f", function, "--buckets", "0"});
  }
  static std::vector<std::string> values_of(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
  }
};

// In the converted mesh, the vertices that stay have other numbers.
TEST_F(ImageWithGaps, HasTheValuesOfItsMesh) {
  std::map<std::string, int> compared;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::vector<std::uint64_t> present = write_image(seed);
    expect_success(reeb({"convert", "v.nrrd", "v.cx", "--nodata", "skip", "--force"}));
    const std::uint64_t at = seed % present.size();
    for (const std::string function : {"geodesic", "distance"}) {
      const std::string of_image = function + ":" + std::to_string(present[at]);
      const Outcome values = reeb({"function", "v.nrrd", "--nodata", "skip", "-f", of_image, "-o", "a.txt", "--force"});
      const Outcome expected =
          reeb({"function", "v.cx", "-f", function + ":" + std::to_string(at), "-o", "b.txt", "--force"});
      ASSERT_EQ(values.exit_code, expected.exit_code) << values.error << expected.error;
      if (expected.exit_code != 0) continue;  // a component is not reached
      ++compared[function];
      const auto all = values_of(file("a.txt")), some = values_of(file("b.txt"));
      ASSERT_EQ(some.size(), present.size());
      for (std::size_t i = 0; i < present.size(); ++i) EXPECT_EQ(all.at(present[i]), some[i]) << function << " " << i;
      EXPECT_EQ(std::ranges::count(all, "nan"), static_cast<std::ptrdiff_t>(all.size() - present.size()));
    }
  }
  EXPECT_EQ(compared["distance"], 20);
  EXPECT_GE(compared["geodesic"], 5);
}

// The highest values of the triangles of `mesh`, an OBJ, in order; values are by the line of a vertex.
std::vector<double> highest_values(const std::string& mesh, const std::map<std::string, double>& value_at) {
  std::vector<double> values, highest;
  std::istringstream lines(mesh);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("v ")) values.push_back(value_at.at(line));
    if (!line.starts_with("f ")) continue;
    std::istringstream corners(line.substr(2));
    std::size_t a = 0, b = 0, c = 0;
    corners >> a >> b >> c;
    highest.push_back(std::max({values.at(a - 1), values.at(b - 1), values.at(c - 1)}));
  }
  return highest;
}

// Functions of the index mean that of the image there, too.
TEST_F(ImageWithGaps, IsSortedByTheValuesOfItsOwnVertices) {
  std::size_t triangles = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::vector<std::uint64_t> present = write_image(seed);
    expect_success(reeb({"convert", "v.nrrd", "kept.obj", "--nodata", "skip", "--force"}));
    expect_success(reeb({"function", "v.nrrd", "--nodata", "skip", "-f", "random:5", "-o", "random.txt", "--force"}));
    const std::vector<std::string> values = values_of(file("random.txt"));
    std::map<std::string, double> value_at;
    std::istringstream lines(file("kept.obj"));
    std::size_t next = 0;
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("v ")) value_at[line] = std::stod(values.at(present.at(next++)));
    ASSERT_EQ(value_at.size(), present.size());
    for (const std::string function : {"random:5", "file:random.txt"}) {
      expect_success(
          reeb({"convert", "v.nrrd", "sorted.obj", "--nodata", "skip", "--order", "sweep:" + function, "--force"}));
      const std::vector<double> highest = highest_values(file("sorted.obj"), value_at);
      EXPECT_TRUE(std::ranges::is_sorted(highest)) << function;
      triangles += highest.size();
    }
  }
  EXPECT_GT(triangles, 1000u);
}

TEST_F(ImageWithGaps, IsGluedFromPartsAndReadsItsOwnValues) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::vector<std::uint64_t> present = write_image(seed);
    const std::string functions[] = {"value", "index", "random:3", "x", "distance:" + std::to_string(present.back())};
    const std::string& function = functions[seed % std::size(functions)];
    const std::string graph = graph_of_image(function);
    expect_success(reeb({"verify", "out.reeb", "--mesh", "v.nrrd", "--nodata", "skip", "--full"}));
    const std::string whole = file("out.reeb");
    std::vector<std::string> glue{"glue"};
    const std::uint64_t parts = 1 + seed % 4;
    for (std::uint64_t k = 1; k <= parts; ++k) {
      const std::string name = std::to_string(k) + ".fragment";
      expect_success(reeb({"fragment", "v.nrrd", "--nodata", "skip", "-f", function, "--buckets", "0", "--part",
                           std::to_string(k) + "/" + std::to_string(parts), "-o", name, "--force"}));
      glue.push_back(name);
    }
    glue.insert(glue.end(), {"--buckets", "0", "-o", "glued.reeb", "--force"});
    expect_success(reeb(glue));
    EXPECT_EQ(file("glued.reeb"), whole) << function;

    for (const std::string values : {"f.txt", "f.f64"}) {
      expect_success(reeb({"function", "v.nrrd", "--nodata", "skip", "-f", function, "-o", values, "--force"}));
      const std::string again = graph_of_image("file:" + values);
      EXPECT_EQ(again.substr(again.find("\nn ")), graph.substr(graph.find("\nn "))) << function;
    }
  }
}

// Boxes need little memory. With --manifold it is glued as it comes, or read again from a copy on disk.
TEST_F(ImageWithGaps, HasTheSameGraphWithLittleMemory) {
  expect_success(reeb({"generate", "volume", "--grid", "12000x12", "--handles", "9", "-o", "v.nrrd"}));
  const std::vector<std::string> options = {"--nodata", "skip", "-f", "random:1", "--buckets", "0", "--graph-only"};
  const auto bytes_with = [&](std::vector<std::string> more, bool is_copied) {
    more.insert(more.begin(), {"compute", "v.nrrd", "-o", "out.reeb", "--force"});
    more.insert(more.end(), options.begin(), options.end());
    const Outcome outcome = reeb(more);
    expect_success(outcome);
    EXPECT_EQ(outcome.error.find("too many vertices of the stream") != std::string::npos, is_copied) << outcome.error;
    return file("out.reeb");
  };
  const std::string graph = bytes_with({"--memory", "16M"}, false);
  EXPECT_EQ(bytes_with({"--memory", "16M", "--manifold"}, true), graph);
  EXPECT_EQ(bytes_with({"--no-reorder", "--manifold"}, false), graph);
}

TEST_F(ImageWithGaps, HasNoVertexWithoutData) {
  write("v.nrrd", "NRRD0005\ntype: int\ndimension: 2\nsizes: 3 1\nencoding: ascii\nnodata:=-9\n\n1 -9 2\n");
  for (const std::string function : {"distance:1", "geodesic:1"})
    expect_error(reeb({"compute", "v.nrrd", "--nodata", "skip", "-f", function, "-o", "out.reeb"}), 1,
                 "v.nrrd: " + function + " names");
  expect_error(reeb({"compute", "v.nrrd", "--nodata", "skip", "-f", "distance:3", "-o", "out.reeb"}), 1,
               "v.nrrd: distance:3 names a vertex that does not exist");
}

TEST_F(Image, OfTwoDimensionsHasNoSurfaceToCheck) {
  write("v.nrrd", "NRRD0005\ntype: int\ndimension: 2\nsizes: 2 2\nencoding: ascii\n\n1 2 3 4\n");
  const Outcome outcome = reeb({"compute", "v.nrrd"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("mesh: 4 vertices, 2 triangles"), std::string::npos) << outcome.error;
  EXPECT_EQ(outcome.error.find("surface"), std::string::npos) << outcome.error;
}

TEST_F(Image, MustHaveFiniteValuesWhereTheyAreUsed) {
  std::vector<float> values(7 * 6 * 5, 1);
  values[17] = std::numeric_limits<float>::quiet_NaN();
  write_raw("v.raw", values);
  const auto with = [](std::vector<std::string> more) {
    std::vector<std::string> words{"compute", "v.raw", "-o", "out.reeb", "--force"};
    words.insert(words.end(), kSmallGrid.begin(), kSmallGrid.end());
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_error(reeb(with({})), 1, "v.raw:68: value of vertex 17 is not finite");
  const Outcome by_x = reeb(with({"-f", "x"}));
  expect_success(by_x);
  EXPECT_NE(by_x.error.find("1 value of the image is not finite"), std::string::npos) << by_x.error;
  expect_success(reeb(with({"--nodata", "skip"})));
}

TEST_F(Image, IsDescribedByItsOptions) {
  write_raw("v.raw", std::vector<float>(7 * 6 * 5, 1));
  expect_error(reeb({"compute", "v.raw"}), 2, "v.raw: a raw file does not say what it holds");
  expect_error(reeb({"compute", "v.raw", "--grid", "7x6x5"}), 2, "--type is missing");
  expect_error(reeb({"compute", "v.raw", "--spacing", "1,1,2"}), 2, "--grid is missing");
  expect_error(reeb({"compute", "v.raw", "--grid", "99999999999x99999999999", "--type", "u8"}), 2,
               "--grid 99999999999x99999999999 has more than 2^56 vertices");
  expect_error(reeb({"compute", "v.raw", "--grid", "7x6x5", "--type", "f32"}), 2);
  expect_error(reeb({"compute", "v.raw", "--grid", "7x6x5", "--type", "f32le", "--nodata", "keep"}), 2);
  write("mesh.off", kSmallOff);
  expect_error(reeb({"compute", "mesh.off", "--nodata", "skip"}), 2, "mesh.off: --nodata is for images");
  expect_error(reeb({"compute", "v.raw", "--grid", "7x6x4", "--type", "f32le"}), 1);
  const auto info = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"info", "v.raw", "--json"});
    const Outcome outcome = reeb(options);
    expect_success(outcome);
    return nlohmann::json::parse(outcome.output);
  };
  const auto whole = info({"--grid", "7x6x5", "--type", "f32le", "--spacing", "1,2,0.5"});
  EXPECT_EQ(whole["vertices"], 7 * 6 * 5);
  EXPECT_EQ(whole["bounds"][1]["max"], 10);
  EXPECT_EQ(whole["bounds"][2]["max"], 2);
  EXPECT_EQ(whole["dimension"], 3);
  const auto plane = info({"--grid", "7x6", "--type", "f32le", "--skip", "672"});
  EXPECT_EQ(plane["vertices"], 7 * 6);
  EXPECT_EQ(plane["dimension"], 2);
}

TEST_F(Image, IsMeasuredWithItsOptions) {
  Random random(4);
  std::vector<float> values(6 * 5);
  for (float& value : values) value = static_cast<float>(random.unit());
  values[7] = values[20] = std::numeric_limits<float>::quiet_NaN();
  write_raw("v.raw", values);
  const std::vector<std::string> options = {"--grid", "6x5", "--type", "f32le", "--nodata", "skip"};
  graph_of("v.raw", options);
  std::vector<std::string> extract = {"extract", "out.reeb", "--mesh", "v.raw", "--format", "json", "-o", "a.json"};
  extract.insert(extract.end(), options.begin(), options.end());
  expect_success(reeb(extract));
  // The 40 triangles but the six at each vertex that is left out.
  double area = 0;
  const nlohmann::json graph = nlohmann::json::parse(file("a.json"));
  for (const auto& arc : graph["arcs"]) area += arc["area"].get<double>();
  EXPECT_NEAR(area, (40 - 2 * 6) / 2.0, 1e-9);

  expect_error(reeb({"extract", "out.reeb", "--grid", "6x5", "--type", "f32le"}), 2, "--grid, --type, ");
  expect_error(reeb({"segment", "v.raw", "out.reeb", "-o", "a.i64", "--grid", "6x5", "--type", "f32le"}), 1);
}

TEST_F(Image, WithAHeaderTakesNoOptionsOfRawOnes) {
  const std::string header = "NRRD0005\ntype: uchar\ndimension: 2\nsizes: 2 2\nencoding: ascii\n\n";
  write("v.nrrd", header + "1 2 3 4\n");
  const Outcome spacing = reeb({"compute", "v.nrrd", "--spacing", "1,2"});
  expect_error(spacing, 2, "v.nrrd: --spacing is for raw images; an NRRD image says this in its header");
  expect_error(reeb({"info", "v.nrrd", "--type", "u8"}), 2, "v.nrrd: --type is for raw images; an NRRD image");
  write("v.npy", "\x93NUMPY\x01" + std::string("\0\x3a\0", 3) +
                     "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2)} " + "1234");
  expect_success(reeb({"info", "v.npy"}));
  expect_error(reeb({"compute", "v.npy", "--spacing", "1,2"}), 2,
               "v.npy: --spacing is for raw images; the vertices of a NumPy array are 1 apart");
  write("mesh.off", kSmallOff);
  expect_error(reeb({"compute", "mesh.off", "--spacing", "1,1,2"}), 2,
               "mesh.off: --spacing is for raw images, and this is a mesh");
}

TEST_F(Image, SaysItsGridItsTypeAndItsSpacing) {
  const std::string begin = "NRRD0005\ntype: short\ndimension: 3\nsizes: 3 2 2\nencoding: ascii\n";
  const std::string end = "\n1 2 3 4 5 6 7 8 9 10 11 12\n";
  write("a.nrrd", begin + end);
  write("b.nrrd", begin + "spacings: 0.5 1 2.5\n" + end);
  const std::string a = reeb({"info", "a.nrrd"}).output, b = reeb({"info", "b.nrrd"}).output;
  EXPECT_NE(a.find("  grid          3 x 2 x 2, i16, spacing 1 x 1 x 1 (not in the file)\n"), std::string::npos) << a;
  EXPECT_NE(b.find("  grid          3 x 2 x 2, i16, spacing 0.5 x 1 x 2.5\n"), std::string::npos) << b;
  EXPECT_EQ(a.find("finalization"), std::string::npos) << a;
  const auto json = nlohmann::json::parse(reeb({"info", "b.nrrd", "--json"}).output)["grid"];
  EXPECT_EQ(json["size"], nlohmann::json({3, 2, 2}));
  EXPECT_EQ(json["type"], "i16");
  EXPECT_EQ(json["spacing"], nlohmann::json({0.5, 1, 2.5}));
  EXPECT_EQ(json["spacing_in_file"], true);
  const Outcome converted = reeb({"convert", "a.nrrd", "a.ply"});
  expect_success(converted);
  const std::string note = "note: all faces of the tetrahedra are written, not an isosurface\n";
  EXPECT_NE(converted.error.find(note), std::string::npos) << converted.error;
  EXPECT_EQ(reeb({"convert", "a.nrrd", "a.sva"}).error.find(note), std::string::npos);
}

TEST_F(Image, OfSeveralChannelsSaysWhichOneIsUsed) {
  std::string values;
  for (int v = 0; v < 3 * 9 * 9; ++v) values += std::to_string(v * v % 17) + "\n";
  const std::string begin = "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 3 9 9\nencoding: ascii\n";
  write("volume.nrrd", begin + "\n" + values);
  write("colors.nrrd", begin + "kinds: RGB-color domain domain\n\n" + values);
  const auto error_of = [&](const std::string& mesh, const std::string& function) {
    const Outcome outcome = reeb({"compute", mesh, "-f", function, "-o", "o.reeb", "--force"});
    expect_success(outcome);
    return outcome.error;
  };
  const std::string axis = "note: an axis is 3 long; if this is a colour image, use one of its channels\n";
  EXPECT_NE(error_of("volume.nrrd", "value").find(axis), std::string::npos);
  EXPECT_EQ(error_of("volume.nrrd", "x").find(axis), std::string::npos);
  const std::string channels = "note: each vertex has 3 values; value is the first, value:1 the second\n";
  EXPECT_NE(error_of("colors.nrrd", "value").find(channels), std::string::npos);
  EXPECT_EQ(error_of("colors.nrrd", "value:1").find(channels), std::string::npos);
  EXPECT_EQ(error_of("colors.nrrd", "value").find(axis), std::string::npos);
}

TEST_F(Image, AloneHasAValue) {
  write("mesh.off", kSmallOff);
  expect_error(reeb({"compute", "mesh.off", "-f", "value"}), 1);
  write("mesh.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float value\nend_header\n0 0 0 1\n");
  expect_error(reeb({"compute", "mesh.ply", "-f", "value"}), 1, "mesh.ply: the mesh is not an image");
  expect_success(reeb({"compute", "mesh.ply", "-f", "property:value"}));
}

}  // namespace
}  // namespace reeb::test
