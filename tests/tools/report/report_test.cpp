// `reeb report`: what the page says, without a browser. tests/web has what it does in one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <regex>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

#include "libreeb/base/count_text.h"
#include "tests/support/inputs/planted_mesh.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using Json = nlohmann::json;

bool built_with_pages() { return REEB_WEB != 0; }

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

class Report : public ProgramTest {
 protected:
  void SetUp() override {
    if (!built_with_pages()) GTEST_SKIP() << "not here: built with REEB_WEB=OFF";
  }
  // Writes mesh.off, and the page about its graph.
  std::string report(const std::string& mesh, std::vector<std::string> compute = {},
                     std::vector<std::string> words = {}) {
    write("mesh.off", mesh);
    compute.insert(compute.begin(), {"compute", "mesh.off", "-o", "g.reeb", "--quiet", "--force"});
    expect_success(reeb(compute));
    words.insert(words.begin(), {"report", "g.reeb", "-o", "g.html", "--force"});
    expect_success(reeb(words));
    return file("g.html");
  }
  static Json data(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const auto at = page.find(begin) + begin.size();
    return Json::parse(page.substr(at, page.find("</script>", at) - at));
  }
  // The cell beside the heading NAME of a summary, without the commas of numbers.
  static std::string cell(const std::string& page, const std::string& name) {
    const std::regex row("<tr><th scope=\"row\">" + name + "</th><td>([^<]*)</td></tr>");
    std::smatch found;
    if (!std::regex_search(page, found, row)) return "none";
    return std::regex_replace(found[1].str(), std::regex(",(?=\\d{3})"), "");
  }
  std::string planted(std::uint64_t seed = 1) const {
    PlantedOptions options;
    options.seed = seed;
    return to_off(planted_mesh(options));
  }
};

constexpr const char* kPoint = "OFF\n1 0 0\n1 2 3\n";

TEST_F(Report, SummaryIsThatOfTheFile) {
  const std::string page = report(planted(), {"--buckets", "16"});
  const auto info = Json::parse(reeb({"info", "g.reeb", "--json"}).output);
  for (const char* name : {"nodes", "arcs", "components", "loops"})
    EXPECT_EQ(cell(page, name), info["graph"][name].dump()) << name;
  EXPECT_EQ(cell(page, "function"), "z");
  EXPECT_EQ(cell(page, "mesh triangles"), info["input"]["triangles"].dump());
  EXPECT_EQ(cell(page, "loops \\(Ext1 pairs\\)"), info["graph"]["loops"].dump());
  EXPECT_NE(cell(page, "loops"), "0");
  EXPECT_NE(page.find("mesh triangles</th><td>" + with_commas(info["input"]["triangles"])), std::string::npos);
}

TEST_F(Report, SaysWhetherTheMeshWasChecked) {
  const std::string unchecked = report(kSmallOff), checked = report(kSmallOff, {}, {"--mesh", "mesh.off"});
  EXPECT_NE(unchecked.find("The mesh was not checked (give it with --mesh)."), std::string::npos);
  EXPECT_EQ(unchecked.find("Nothing unusual"), std::string::npos);
  EXPECT_NE(checked.find("Nothing unusual was found."), std::string::npos);
  EXPECT_EQ(checked.find("not checked"), std::string::npos);
}

// At every threshold the records give as many nodes and arcs as `extract`.
TEST_F(Report, LevelsAreThoseOfExtract) {
  const Json skeleton = data(report(planted()))["skeleton"];
  const auto& levels = skeleton["levels"];
  const std::size_t count = levels["version"].size();
  ASSERT_GT(count, 10u);
  for (std::size_t i = 0; i < count; i += 1 + count / 12) {
    const double threshold = levels["threshold"][i];
    const auto graph =
        Json::parse(reeb({"extract", "g.reeb", "--format", "json", "--threshold", exact(threshold)}).output);
    EXPECT_EQ(levels["arcs"][i], graph["arcs"].size());
    EXPECT_EQ(levels["nodes"][i], graph["nodes"].size());
    std::size_t arcs = 0;
    const auto& records = skeleton["arcs"];
    const std::uint32_t version = levels["version"][i];
    for (std::size_t k = 0; k < records["born"].size(); ++k)
      arcs += records["born"][k] <= version && (records["died"][k].is_null() || records["died"][k] > version);
    EXPECT_EQ(arcs, graph["arcs"].size()) << threshold;
  }
}

// A funnel whose radius grows evenly from 1 to 3.
std::string funnel() {
  constexpr int kRings = 64, kSides = 48;
  std::string text =
      "OFF\n" + std::to_string(kRings * kSides) + " " + std::to_string(2 * (kRings - 1) * kSides) + " 0\n";
  for (int ring = 0; ring < kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const double radius = 1 + 2.0 * ring / (kRings - 1), angle = 2 * 3.141592653589793 * side / kSides;
      text += exact(radius * std::cos(angle)) + " " + exact(radius * std::sin(angle)) + " " +
              exact(ring + 0.01 * side) + "\n";
    }
  for (int ring = 0; ring + 1 < kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const int a = ring * kSides + side, b = ring * kSides + (side + 1) % kSides;
      for (const auto& [p, q, r] : {std::tuple(a, b, b + kSides), std::tuple(a, b + kSides, a + kSides)})
        text += "3 " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
    }
  return text;
}

std::vector<int> numbers16(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<int> bytes, numbers;
  int bits = 0, value = 0;
  for (const char digit : base64) {
    if (digit == '=') break;
    value = (value << 6 | static_cast<int>(digits.find(digit))) & 0xffff;
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes.push_back(value >> bits & 0xff);
  }
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) numbers.push_back(bytes[i] | bytes[i + 1] << 8);
  return numbers;
}

TEST_F(Report, WidthsFollowTheRadius) {
  const Json arcs = data(report(funnel()))["skeleton"]["arcs"];
  std::size_t longest = 0, first = 0, at = 0, points = 0;
  for (std::size_t i = 0; i < arcs["points"].size(); ++i) {
    const std::size_t here = arcs["points"][i];
    if (here >= points) {
      longest = i;
      first = at;
      points = here;
    }
    at += here + 2;
  }
  const std::vector<int> widths = numbers16(arcs["width"]);
  ASSERT_EQ(widths.size(), at) << longest;
  EXPECT_NEAR(widths[first], 65535 / 3, 3000);
  EXPECT_GT(widths[first + points + 1], 60000);
}

TEST_F(Report, FewNodesMeanCoarserLevels) {
  const std::string page = report(planted(), {}, {"--nodes", "10"});
  const Json skeleton = data(page)["skeleton"];
  EXPECT_LE(skeleton["levels"]["nodes"][0], 10);
  EXPECT_NE(page.find("--nodes N sets another limit"), std::string::npos);
  EXPECT_TRUE(data(report(planted(), {}, {"--nodes", "1"}))["skeleton"].is_null());
  // 1,500 triangles apart: the coarsest level has two nodes of each.
  std::string apart = "OFF\n4500 1500 0\n";
  for (int i = 0; i < 1500; ++i)
    for (const char* yz : {" 0 0\n", " 1 0\n", " 0 1\n"}) apart += std::to_string(2 * i) + yz;
  for (int i = 0; i < 4500; i += 3)
    apart += "3 " + std::to_string(i) + ' ' + std::to_string(i + 1) + ' ' + std::to_string(i + 2) + '\n';
  write("apart.off", apart);
  expect_success(reeb({"apart.off"}));
  expect_success(reeb({"report", "apart.reeb", "-o", "apart.html"}));
  EXPECT_EQ(data(file("apart.html"))["skeleton"]["levels"]["nodes"][0], 3000);
  const Outcome few = reeb({"report", "apart.reeb", "--nodes", "2000", "-o", "few.html"});
  EXPECT_TRUE(few.error.starts_with("note: no skeleton: the coarsest level has 3,000 nodes; --nodes 3000"))
      << few.error;
}

TEST_F(Report, FiveMegabytesAreEnoughForAThousandNodes) {
  expect_success(reeb({"generate", "scan", "--triangles", "200k", "-o", "scan.ply"}));
  expect_success(reeb({"compute", "scan.ply", "--quiet"}));
  expect_success(reeb({"report", "scan.reeb", "--mesh", "scan.ply", "--nodes", "1000", "-o", "scan.html", "--quiet"}));
  EXPECT_GT(data(file("scan.html"))["skeleton"]["levels"]["nodes"][0], 500);
  EXPECT_LE(file("scan.html").size(), 5'000'000u);
}

TEST_F(Report, DefectsAreThoseOfTheMesh) {
  const std::string page = report(planted(), {}, {"--mesh", "mesh.off"});
  expect_success(reeb({"defects", "mesh.off", "g.reeb", "-o", "d.json", "--quiet"}));
  const Json defects = Json::parse(file("d.json"));
  const std::size_t rows = defects["loops"].size();
  ASSERT_GT(rows, 0u);
  EXPECT_EQ(cell(page, "boundaries"), "0");
  const Json closeups = data(page)["closeups"];
  ASSERT_EQ(closeups.size(), std::min<std::size_t>(rows, 12));
  for (std::size_t i = 0; i < closeups.size(); ++i) {
    EXPECT_EQ(closeups[i]["kind"], defects["loops"][i]["kind"]);
    EXPECT_GT(closeups[i]["triangles"].get<std::string>().size(), 100u);
    EXPECT_TRUE(closeups[i]["kind"] == "unclear" || closeups[i]["curve"].size() > 2) << i;
    const Json& loop = defects["loops"][i];
    double length = std::numeric_limits<double>::infinity();
    for (const char* name : {"length_contour", "length_cycle"})
      if (loop[name] != "inf") length = std::min(length, loop[name].get<double>());
    EXPECT_EQ(closeups[i]["length"], std::isfinite(length) ? Json(length) : Json()) << i;
    EXPECT_EQ(closeups[i]["center"], Json({loop["center_x"], loop["center_y"], loop["center_z"]})) << i;
    // The centre of the curve is in the box of the patch.
    for (std::size_t k = 0; k < 3; ++k) {
      const double inside = loop[std::string("center_") + "xyz"[k]].get<double>() - closeups[i]["min"][k].get<double>();
      EXPECT_TRUE(inside >= 0 && inside <= closeups[i]["size"].get<double>()) << i;
    }
  }
}

TEST_F(Report, NamesCannotActAsMarkup) {
  write("v.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty "
        "float <!--<script>\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 "
        "2\n0 1 0 3\n3 0 1 2\n");
  expect_success(reeb({"compute", "v.ply", "-f", "property:<!--<script>", "-o", "<b>&\"'.reeb", "--quiet"}));
  expect_success(reeb({"report", "<b>&\"'.reeb", "-o", "g.html"}));
  const std::string page = file("g.html");
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  EXPECT_EQ(page.find("property:<"), std::string::npos);
  EXPECT_EQ(data(page)["function"], "property:<!--<script>");
  EXPECT_NE(page.find("&lt;b&gt;&amp;&quot;&#39;.reeb"), std::string::npos);
}

TEST_F(Report, DescribesGraphsWithoutLevels) {
  const std::string page = report(planted(), {"--graph-only"});
  EXPECT_NE(page.find("The file has the graph only"), std::string::npos);
  const Json all = data(page);
  EXPECT_TRUE(all["pairs"].empty());
  EXPECT_EQ(all["skeleton"]["levels"]["version"].size(), 1u);
  EXPECT_EQ(all["skeleton"]["levels"]["arcs"][0].dump(), cell(page, "arcs"));
}

TEST_F(Report, DescribesTheSmallestGraphs) {
  const std::string empty = report("OFF\n0 0 0\n", {}, {"--mesh", "mesh.off"});
  EXPECT_EQ(cell(empty, "loops"), "0");
  EXPECT_NE(empty.find("The graph is empty"), std::string::npos);
  const std::string point = report(kPoint, {}, {"--mesh", "mesh.off"});
  EXPECT_EQ(cell(point, "nodes"), "1");
  EXPECT_EQ(data(point)["skeleton"]["isolated"], Json({0}));
}

TEST_F(Report, SaysWhatItWrote) {
  report(planted());
  EXPECT_EQ(reeb({"report", "g.reeb", "-o", "a.html"}).error, "wrote a.html\n");
  EXPECT_EQ(reeb({"report", "g.reeb", "-o", "b.html", "--quiet"}).error, "");
  EXPECT_EQ(reeb({"report", "g.reeb", "-o", "-"}).error, "");
}

TEST_F(Report, IsTheSameEachTime) {
  const std::string page = report(planted(), {}, {"--mesh", "mesh.off"});
  expect_success(reeb({"report", "g.reeb", "--mesh", "mesh.off", "-o", "-", "--quiet"}));
  EXPECT_EQ(reeb({"report", "g.reeb", "--mesh", "mesh.off", "-o", "-", "--quiet", "--threads", "1"}).output, page);
}

TEST_F(Report, RefusesWhatItCannotUse) {
  report(planted());
  expect_error(reeb({"report", "g.reeb"}), 2);
  expect_error(reeb({"report", "g.reeb", "-o", "g.html"}), 1, "g.html: ");
  expect_error(reeb({"report", "mesh.off", "-o", "x.html"}), 1, "mesh.off: this is a mesh");
  expect_error(reeb({"report", "g.reeb", "--mesh", "g.reeb", "-o", "x.html"}), 1, "g.reeb: ");
  expect_error(reeb({"report", "g.reeb", "--mesh", "-", "-o", "x.html"}), 2);
  expect_error(reeb({"report", "g.reeb", "-o", "g.reeb", "--force"}), 1, "g.reeb: ");
  write("other.off", kSmallOff);
  expect_error(reeb({"report", "g.reeb", "--mesh", "other.off", "-o", "x.html"}), 1,
               "g.reeb: this is not the graph of that mesh: it was computed from ");
  const auto names = files();
  EXPECT_EQ(std::ranges::count(names, "x.html"), 0);
}

// A volume has no surface, so no curves, but its graph has a page.
TEST_F(Report, DescribesVolumes) {
  expect_success(reeb({"generate", "volume", "--grid", "12x12x12", "--handles", "1", "-o", "v.nrrd"}));
  expect_success(reeb({"compute", "v.nrrd", "--quiet"}));
  expect_success(reeb({"report", "v.reeb", "--mesh", "v.nrrd", "-o", "v.html", "--quiet"}));
  EXPECT_NE(file("v.html").find("not a surface"), std::string::npos);
  EXPECT_EQ(cell(file("v.html"), "mesh triangles"), "none");
  EXPECT_EQ(cell(file("v.html"), "nodes"),
            Json::parse(reeb({"info", "v.reeb", "--json"}).output)["graph"]["nodes"].dump());
}

// In other units it is another image.
TEST_F(Report, RefusesAnImageOfAnotherSpacing) {
  std::string values;
  for (int i = 0; i < 6 * 6 * 6; ++i) values += static_cast<char>(i * 37 % 101);
  write("v.raw", values);
  const auto of_image = [](std::vector<std::string> words, const char* spacing) {
    words.insert(words.end(), {"--grid", "6x6x6", "--type", "u8", "--spacing", spacing, "--quiet", "--force"});
    return words;
  };
  expect_success(reeb(of_image({"compute", "v.raw"}, "1,1,5")));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"report", "v.reeb", "--mesh", "v.raw", "-o", "v.html"},
        {"extract", "v.reeb", "--mesh", "v.raw", "--format", "json", "-o", "v.json"},
        {"plot", "v.reeb", "--kind", "skeleton", "--mesh", "v.raw", "-o", "v.svg"}}) {
    expect_success(reeb(of_image(words, "1,1,5")));
    const Outcome outcome = reeb(of_image(words, "1,1,4"));
    expect_error(outcome, 1, "v.raw: the node of vertex ");
    EXPECT_NE(outcome.error.find("--spacing"), std::string::npos) << outcome.error;
  }
}

TEST_F(Report, DescribesWhatIsLeftOfADamagedFile) {
  report(planted());
  const std::string bytes = file("g.reeb");
  write("cut.reeb", bytes.substr(0, bytes.size() - 40));
  const Outcome outcome = reeb({"report", "cut.reeb", "-o", "cut.html"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("reeb: warning: "), std::string::npos) << outcome.error;
  EXPECT_NE(file("cut.html").find("The file is damaged"), std::string::npos);
}

// Of the levels, those before the damage are shown.
TEST_F(Report, ShowsWhatIsBeforeADamagedFrame) {
  expect_success(reeb({"generate", "scan", "--triangles", "400k", "-o", "scan.ply"}));
  expect_success(reeb({"compute", "scan.ply", "--quiet"}));
  const std::string bytes = file("scan.reeb");
  std::size_t shown = 0;
  for (const double part : {0.1, 0.3, 0.6, 0.9}) {
    std::string damaged = bytes;
    damaged[static_cast<std::size_t>(part * static_cast<double>(bytes.size()))] ^= 1;
    write("damaged.reeb", damaged);
    const Outcome outcome = reeb({"report", "damaged.reeb", "--nodes", "100k", "-o", "damaged.html", "--force"});
    expect_success(outcome);
    EXPECT_NE(outcome.error.find(" cannot be read: "), std::string::npos) << outcome.error;
    const std::string page = file("damaged.html");
    EXPECT_NE(page.find(" cannot be read: "), std::string::npos);
    const Json skeleton = data(page)["skeleton"];
    if (skeleton.is_null()) continue;
    ++shown;
    const std::uint64_t nodes = skeleton["levels"]["nodes"][0];
    const Outcome level = reeb({"extract", "damaged.reeb", "--nodes", std::to_string(nodes), "-o", "l.rg", "--force"});
    EXPECT_EQ(level.exit_code, 0) << level.error;
  }
  EXPECT_GE(shown, 2u);
}

TEST_F(Report, ShowsTheLevelsThatACutFileHas) {
  expect_success(reeb({"generate", "scan", "--triangles", "400k", "-o", "scan.ply"}));
  expect_success(reeb({"compute", "scan.ply", "--quiet"}));
  const std::string bytes = file("scan.reeb");
  write("cut.reeb", bytes.substr(0, bytes.size() * 6 / 10));
  const Json levels = Json::parse(reeb({"info", "cut.reeb", "--json"}).output)["levels"];
  Json finest;
  for (const Json& level : levels)
    if (level["whole"] == true) finest = level;
  ASSERT_FALSE(finest.is_null());
  ASSERT_FALSE(levels.back()["whole"].get<bool>());
  EXPECT_NE(reeb({"info", "cut.reeb"}).output.find("  missing\n"), std::string::npos);
  expect_success(reeb({"report", "cut.reeb", "--nodes", "100k", "-o", "cut.html"}));
  const std::string page = file("cut.html");
  EXPECT_EQ(data(page)["skeleton"]["levels"]["nodes"][0], finest["nodes"]);
  EXPECT_NE(page.find("<p>The pairs cannot be read, so there is no list of features.</p>"), std::string::npos);
  EXPECT_EQ(page.find("The file has no pairs, "), std::string::npos);
  // Other commands say which level works, and it does.
  for (const std::vector<std::string>& words : {std::vector<std::string>{"extract", "cut.reeb", "-o", "g.json"},
                                                {"plot", "cut.reeb", "--kind", "skeleton", "-o", "g.svg"}}) {
    const Outcome outcome = reeb(words);
    EXPECT_EQ(outcome.exit_code, 1);
    std::istringstream hint(lines_after("hint: ", outcome.error).at(0));
    std::string option, value;
    hint >> option >> value;
    EXPECT_TRUE(option == "--nodes" || option == "--threshold") << outcome.error;
    std::vector<std::string> level = words;
    level.insert(level.end(), {option, value});
    expect_success(reeb(level));
  }
  EXPECT_EQ(Json::parse(file("g.json"))["nodes"].size(), finest["nodes"]);
  // By the number of its nodes, too, though the frames after it are missing.
  for (const char* name : {"cut", "scan"})
    expect_success(reeb(
        {"extract", name + std::string(".reeb"), "--nodes", finest["nodes"].dump(), "-o", name + std::string(".rg")}));
  EXPECT_EQ(file("cut.rg"), file("scan.rg"));
  const Outcome pairs = reeb({"pairs", "cut.reeb"});
  EXPECT_EQ(lines_after("hint: pairs are at the end of a file", pairs.error).size(), 1u) << pairs.error;
}

TEST_F(Report, SaysWhatAnOutputOfAnotherSuffixIs) {
  report(planted());
  EXPECT_EQ(reeb({"report", "g.reeb", "-o", "t.pdf"}).error, "note: t.pdf is an HTML page\nwrote t.pdf\n");
}

class ReportWithoutPages : public ProgramTest {};

TEST_F(ReportWithoutPages, SaysSo) {
  if (built_with_pages()) GTEST_SKIP() << "not here: built with pages";
  expect_error(reeb({"report", "g.reeb", "-o", "g.html"}), 3, "this program was built without pages");
}

}  // namespace
}  // namespace reeb::test
