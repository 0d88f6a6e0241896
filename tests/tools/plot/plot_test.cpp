// `reeb plot` as a user runs it: what is in its pictures, against `reeb extract` and `reeb pairs`.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <regex>
#include <utility>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

std::size_t count_of(const std::string& part, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

bool is_installed(const std::string& program) {
  return run_process({.arguments = {"sh", "-c", "command -v " + program}}).exit_code == 0;
}

#define REEB_NEEDS(program)                                     \
  do {                                                          \
    if (!is_installed(program)) GTEST_SKIP() << "no " #program; \
  } while (false)

class Plot : public ProgramTest {
 protected:
  void SetUp() override {
    expect_success(reeb({"generate", "scan", "--triangles", "3k", "-o", "scan.ply"}));
    expect_success(reeb({"compute", "scan.ply"}));
  }
  std::size_t lines(const std::string& begin, const std::string& threshold) {
    return lines_after(begin, reeb({"extract", "scan.reeb", "--threshold", threshold}).output).size();
  }
  Outcome check_xml(const std::string& name) const {
    return run_process({.arguments = {"xmllint", "--noout", in_folder(name)}});
  }
  void expect_valid(const std::string& name) {
    if (is_installed("xmllint")) {
      const Outcome outcome = check_xml(name);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    }
    EXPECT_LE(file(name).size(), 2u << 20);
  }
};

TEST_F(Plot, GraphHasTheNodesAndArcsOfItsLevel) {
  REEB_NEEDS("dot");
  for (const std::string threshold : {"0", "1%", "5%"}) {
    const std::string name = "graph" + threshold + ".svg";
    expect_success(reeb({"plot", "scan.reeb", "--kind", "graph", "--threshold", threshold, "-o", name}));
    expect_valid(name);
    EXPECT_EQ(count_of("class=\"node\"", file(name)), lines("n ", threshold));
    EXPECT_EQ(count_of("class=\"arc\"", file(name)), lines("a ", threshold));
  }
}

// Without xmllint, expect_valid() only looks at sizes.
TEST_F(Plot, IsXml) {
  REEB_NEEDS("xmllint");
  expect_success(reeb({"plot", "scan.reeb", "--kind", "skeleton", "-o", "s.svg"}));
  EXPECT_EQ(check_xml("s.svg").exit_code, 0);
  write("cut.svg", file("s.svg").substr(0, file("s.svg").size() / 2));
  EXPECT_NE(check_xml("cut.svg").exit_code, 0);
}

// It has no option for that.
TEST_F(Plot, NamesTheVariableOfAFolderForTemporaryFiles) {
  REEB_NEEDS("dot");
  const Outcome outcome = reeb({"plot", "scan.reeb", "--kind", "graph", "-o", "g.svg"},
                               {.arguments = {}, .wrapper = {"env", "TMPDIR=/nonexistent"}});
  expect_error(outcome, 3, "/nonexistent: ");
  EXPECT_EQ(lines_after("hint: ", outcome.error).at(0), "set TMPDIR to a folder that exists and is writable");
}

TEST_F(Plot, SkeletonsOfAnySizeFillTheirPicture) {
  for (const std::string scale : {"", "e308", "e300", "e-300"}) {
    SCOPED_TRACE(scale);
    write("big.obj", "v 0 0 -1.7" + scale + "\nv 1" + scale + " 0 1.7" + scale + "\nv 0 1" + scale + " 0.3" + scale +
                         "\nf 1 2 3\n");
    expect_success(reeb({"compute", "big.obj", "-o", "big.reeb", "--force", "--quiet"}));
    expect_success(reeb({"plot", "big.reeb", "--kind", "skeleton", "-o", "big.svg", "--force", "--quiet"}));
    expect_valid("big.svg");
    // The arc leads from the lower side of the box to the upper one.
    const std::string text = file("big.svg"), arc = text.substr(text.find("<g class=\"arc\">"), 80);
    EXPECT_NE(arc.find(",708L"), std::string::npos) << arc;
    EXPECT_NE(arc.find(",68\" stroke"), std::string::npos) << arc;
  }
}

TEST_F(Plot, SkeletonHasTheNodesAndArcsOfItsLevel) {
  for (const std::string style : {"solid", "glass", "value", "none"}) {
    const std::string name = style + ".svg";
    expect_success(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--mesh", "scan.ply", "--threshold", "1%",
                         "--surface", style, "--color", style == "none" ? "arcs" : "value", "-o", name}));
    expect_valid(name);
    EXPECT_EQ(count_of("class=\"node\"", file(name)), lines("n ", "1%"));
    EXPECT_EQ(count_of("class=\"arc\"", file(name)), lines("a ", "1%"));
    EXPECT_EQ(count_of("<image", file(name)), style == "none" ? 0u : 1u);
  }
  expect_success(reeb({"plot", "scan.reeb", "--kind", "skeleton", "-o", "alone.svg"}));
  EXPECT_EQ(count_of("<image", file("alone.svg")), 0u);
}

TEST_F(Plot, SkeletonIsSeenFromWhereOneSays) {
  const auto picture = [&](const std::string& view) {
    return reeb({"plot", "scan.reeb", "--kind", "skeleton", "--view", view, "-o", "-"}).output;
  };
  EXPECT_NE(picture("0,0,1").find("seen from 0,0,1"), std::string::npos);
  EXPECT_NE(picture("0,0,1"), picture("1,0,0.5"));
  // The length of a direction does not count.
  EXPECT_EQ(picture("0,0,1"), picture("0,0,2.5"));
}

TEST_F(Plot, LoopsAreACurve) {
  REEB_NEEDS("gnuplot");
  expect_success(reeb({"plot", "scan.reeb"}));
  expect_valid("scan.svg");
  const std::string pairs = reeb({"pairs", "scan.reeb"}).output;
  const std::size_t loops = count_of("\nExt1,", pairs);
  ASSERT_GT(loops, 3u);
  EXPECT_EQ(count_of("<use xlink:href='#gpPt6'", file("scan.svg")), 0u);
  EXPECT_NE(file("scan.svg").find(std::to_string(loops) + " loops"), std::string::npos);
}

TEST_F(Plot, DiagramHasAPointForEachPair) {
  REEB_NEEDS("gnuplot");
  for (const std::string threshold : {"0", "1%"}) {
    const std::string name = "diagram" + threshold + ".svg";
    expect_success(reeb({"plot", "scan.reeb", "--kind", "diagram", "--threshold", threshold, "-o", name}));
    expect_valid(name);
    // A pair of the level is one with this persistence, or one that is never cancelled. The range is that of y.
    std::size_t expected = 0;
    const std::string pairs = reeb({"pairs", "scan.reeb"}).output;
    const auto cells_of = [](const std::string& row) {
      std::vector<std::string> cells;
      for (std::size_t at = 0; at <= row.size();) {
        const std::size_t end = std::min(row.find(',', at), row.size());
        cells.push_back(row.substr(at, end - at));
        at = end + 1;
      }
      return cells;
    };
    const double range = std::stod(cells_of(lines_after("Ext0,", pairs).at(0))[4]);
    for (const char* type : {"Ext0,", "Ext1,", "Ord0,", "Rel1,"})
      for (const std::string& row : lines_after(type, pairs)) {
        const std::vector<std::string> cells = cells_of(row);
        const bool stays = cells.back() == "1" || std::string(type) == "Ext0,";
        expected += stays || threshold == "0" || std::stod(cells[4]) >= 0.01 * range;
      }
    ASSERT_GT(expected, 0u);
    // One more of each type in the key.
    EXPECT_EQ(count_of("' transform='translate(", file(name)), expected + 4) << threshold;
  }
}

TEST_F(Plot, DrawsOneNodeAndSaysThatThereIsNothing) {
  REEB_NEEDS("gnuplot");
  REEB_NEEDS("dot");
  write("empty.off", "OFF\n0 0 0\n");
  write("one.off", "OFF\n1 0 0\n1 2 3\n");
  for (const std::string name : {"empty", "one"}) {
    expect_success(reeb({"compute", name + ".off"}));
    for (const std::string kind : {"loops", "diagram", "graph", "skeleton"}) {
      const std::string picture = name + "-" + kind + ".svg";
      std::vector<std::string> words = {"plot", name + ".reeb", "--kind", kind, "-o", picture};
      if (kind == "skeleton") words.insert(words.end(), {"--mesh", name + ".off"});
      expect_success(reeb(words));
      expect_valid(picture);
      EXPECT_EQ(count_of("The graph is empty.", file(picture)), name == "empty" ? 1u : 0u) << picture;
    }
  }
  EXPECT_EQ(count_of("There are no loops.", file("one-loops.svg")), 1u);
  EXPECT_EQ(count_of("class=\"node\"", file("one-graph.svg")), 1u);
  EXPECT_EQ(count_of("class=\"node\"", file("one-skeleton.svg")), 1u);
}

TEST_F(Plot, ShowsAnyName) {
  REEB_NEEDS("gnuplot");
  REEB_NEEDS("dot");
  const std::string name = "o'n\"e <&> $(x) `y` \\alpha_{2} %d";
  std::filesystem::copy_file(in_folder("scan.reeb"), in_folder(name + ".reeb"));
  for (const std::string kind : {"loops", "diagram", "graph", "skeleton"}) {
    expect_success(reeb({"plot", name + ".reeb", "--kind", kind, "--nodes", "50", "-o", kind + ".svg"}));
    expect_valid(kind + ".svg");
    std::string text = file(kind + ".svg");
    for (const auto& [entity, character] : {std::pair("&quot;", "\""), {"&apos;", "'"}, {"&#39;", "'"}, {"&gt;", ">"}})
      for (std::size_t at; (at = text.find(entity)) != std::string::npos;)
        text.replace(at, std::string(entity).size(), character);
    EXPECT_NE(text.find("o'n\"e &lt;&amp;> $(x) `y` \\alpha_{2} %d"), std::string::npos) << kind;
  }
}

// Of a long one the ends, and never a part of a character.
TEST_F(Plot, ShortensLongNames) {
  REEB_NEEDS("gnuplot");
  for (std::size_t length = 60; length < 64; ++length) {
    std::string name = "begin-";
    while (name.size() < length) name += "ä";
    name += std::string(length - 60, '_') + "-end";
    std::filesystem::copy_file(in_folder("scan.reeb"), in_folder(name + ".reeb"));
    for (const std::string kind : {"loops", "skeleton"}) {
      expect_success(reeb({"plot", name + ".reeb", "--kind", kind, "--nodes", "50", "-o", kind + ".svg", "--force"}));
      expect_valid(kind + ".svg");
      const std::string picture = file(kind + ".svg");
      EXPECT_EQ(picture.find(name), std::string::npos);
      EXPECT_NE(picture.find("ä..."), std::string::npos);
      EXPECT_NE(picture.find("-end, f = z"), std::string::npos);
    }
  }
}

TEST_F(Plot, DrawsSeveralFilesInOneChart) {
  REEB_NEEDS("gnuplot");
  expect_success(reeb({"compute", "scan.ply", "-f", "x", "-o", "x.reeb"}));
  const Outcome outcome = reeb({"plot", "scan.reeb", "x.reeb", "-o", "-"});
  expect_success(outcome);
  EXPECT_NE(outcome.output.find("scan, f = z"), std::string::npos);
  EXPECT_NE(outcome.output.find("x, f = x"), std::string::npos);
  std::filesystem::create_directory(in_folder("other"));
  std::filesystem::copy_file(in_folder("scan.reeb"), in_folder("other/scan.reeb"));
  const Outcome equal = reeb({"plot", "scan.reeb", "other/scan.reeb", "x.reeb", "-o", "-"});
  expect_success(equal);
  for (const char* name : {">scan.reeb, f = z: ", ">other/scan.reeb, f = z: ", ">x, f = x: "})
    EXPECT_EQ(count_of(name, equal.output), 1u) << name;
  expect_error(reeb({"plot", "scan.reeb", "x.reeb", "--kind", "diagram"}), 2, "--kind diagram draws one file");
}

TEST_F(Plot, HasATitleForReaders) {
  REEB_NEEDS("gnuplot");
  REEB_NEEDS("dot");
  for (const std::string kind : {"loops", "diagram", "graph", "skeleton"}) {
    const std::string picture = reeb({"plot", "scan.reeb", "--kind", kind, "-o", "-"}).output;
    EXPECT_EQ(count_of("<title>scan, f = z: ", picture), 1u) << kind;
    EXPECT_EQ(count_of(" role=\"img\"", picture), 1u) << kind;
    EXPECT_EQ(count_of("Gnuplot", picture), 0u) << kind;
  }
}

TEST_F(Plot, WritesPngAndPdf) {
  REEB_NEEDS("rsvg-convert");
  for (const auto& [name, begin] : {std::pair("a.png", "\x89PNG"), {"a.pdf", "%PDF"}}) {
    expect_success(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--mesh", "scan.ply", "-o", name}));
    EXPECT_TRUE(file(name).starts_with(begin)) << name;
  }
}

TEST_F(Plot, NamesThePackageThatIsMissing) {
  const auto before = files();
  const std::vector<std::array<std::string, 3>> cases = {{"loops", "a.svg", "gnuplot-nox"},
                                                         {"diagram", "a.svg", "gnuplot-nox"},
                                                         {"graph", "a.svg", "graphviz"},
                                                         {"skeleton", "a.png", "librsvg2-bin"}};
  for (const auto& [kind, name, package] : cases) {
    const Outcome outcome =
        reeb({"plot", "scan.reeb", "--kind", kind, "-o", name}, {.arguments = {}, .environment = {{"PATH", ""}}});
    expect_error(outcome, 3, "the program ");
    EXPECT_NE(outcome.error.find(package), std::string::npos);
  }
  EXPECT_EQ(files(), before);
}

// A program that fails is named with what it said, and nothing is left.
TEST_F(Plot, SaysWhatAProgramComplainsAbout) {
  const auto with_gnuplot = [&](const std::string& script) {
    write("gnuplot", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(in_folder("gnuplot"), std::filesystem::perms::owner_all);
    const auto before = files();
    const Outcome outcome = reeb({"plot", "scan.reeb", "-o", "a.svg"},
                                 {.arguments = {}, .environment = {{"PATH", folder() + ":/usr/bin:/bin"}}});
    EXPECT_EQ(files(), before);
    return outcome;
  };
  expect_error(with_gnuplot("echo 'no such terminal' >&2; exit 1"), 3, "gnuplot failed: no such terminal");
  expect_error(with_gnuplot("kill -9 $$"), 3, "gnuplot was ended by the signal");
  expect_error(with_gnuplot("exit 0"), 3, "gnuplot failed");
}

// The program that draws does not outlive one that is interrupted.
TEST_F(Plot, EndsItsProgramWhenInterrupted) {
  if (kThreadsSanitized) GTEST_SKIP() << "the sanitizer delivers no signal while the program waits for a child";
  write("gnuplot", "#!/bin/sh\necho $$ > pid.new && mv pid.new pid\nexec sleep 600\n");
  std::filesystem::permissions(in_folder("gnuplot"), std::filesystem::perms::owner_all);
  const std::string script =
      "PATH=$PWD:$PATH\n\"$1\" plot scan.reeb -o a.svg & reeb=$!\n"
      "until [ -s pid ]; do sleep 0.02; done\n"
      "kill -TERM $reeb; wait $reeb; echo $?\n"
      "for i in 1 2 3 4 5 6 7 8 9; do\n"
      "  state=$(sed -n 's/^State:[^A-Z]*\\(.\\).*/\\1/p' /proc/$(cat pid)/status 2>/dev/null)\n"
      "  case $state in '' | Z | X) echo gone; break;; esac; sleep 0.1\n"  // nobody may wait for it any more
      "done\n"
      "kill $(cat pid) 2>/dev/null; rm pid gnuplot";
  const auto before = files();
  const Outcome outcome =
      run_process({.arguments = {"bash", "-c", script, "bash", REEB_PROGRAM}, .folder = folder(), .most_seconds = 60});
  EXPECT_EQ(outcome.output, "130\ngone\n") << outcome.error;
  EXPECT_EQ(files().size() + 1, before.size());
}

// The corners of a box are few among its vertices, but the picture has room for them: the scale says how large it is.
TEST_F(Plot, SkeletonHasRoomForAllOfItsMesh) {
  expect_success(reeb({"generate", "volume", "--grid", "64x64x32", "--handles", "3", "-o", "v.nrrd"}));
  expect_success(reeb({"compute", "v.nrrd", "--quiet"}));
  expect_success(reeb({"plot", "v.reeb", "--kind", "skeleton", "--mesh", "v.nrrd", "--view", "1,1,1", "-o", "v.svg"}));
  const std::string picture = file("v.svg");
  std::smatch bar, length;
  ASSERT_TRUE(std::regex_search(picture, bar, std::regex("d=\"M([0-9.]+),[0-9.]+v8m0,-4H([0-9.]+)")));
  ASSERT_TRUE(std::regex_search(picture, length, std::regex(">([0-9.]+) units of length<")));
  const double pixels_per_unit = (std::stod(bar[2]) - std::stod(bar[1])) / std::stod(length[1]);
  // From there, the box is (63 + 63 + 2 * 31) / sqrt(6) high, and the picture has 640 pixels for it.
  EXPECT_NEAR(pixels_per_unit, 640 * std::sqrt(6) / 188, 0.02);
}

TEST_F(Plot, SaysThatAllLoopsAreBelowTheThreshold) {
  REEB_NEEDS("gnuplot");
  const Outcome outcome = reeb({"plot", "scan.reeb", "--threshold", "90", "-o", "none.svg"});
  expect_success(outcome);
  EXPECT_EQ(count_of(" loops are below the threshold.", file("none.svg")), 1u);
  EXPECT_NE(outcome.error.find("note: the threshold 90 is more than the range "), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("did you mean 90%?"), std::string::npos) << outcome.error;
  EXPECT_EQ(reeb({"plot", "scan.reeb", "--threshold", "90%", "-o", "some.svg"}).error, "wrote some.svg\n");
}

TEST_F(Plot, RefusesBeforeAnyWork) {
  write("there.svg", "old");
  expect_error(reeb({"plot", "scan.reeb", "-o", "there.svg"}), 1, "there.svg: ");
  EXPECT_EQ(file("there.svg"), "old");
  expect_error(reeb({"plot", "scan.reeb", "-o", "a.jpg"}), 2, "a.jpg: cannot tell the format");
  expect_error(reeb({"plot", "scan.reeb", "--kind", "tree"}), 2);
  expect_error(reeb({"plot", "scan.reeb", "--threshold", "x"}), 2);
  expect_error(reeb({"plot", "scan.reeb", "--threshold", "1", "--nodes", "4"}), 2);
  expect_error(reeb({"plot", "scan.reeb", "--mesh", "scan.ply"}), 2, "--mesh is for --kind skeleton");
  expect_error(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--surface", "glass"}), 2,
               "--surface needs --mesh MESH");
  for (const std::string view : {"0,0,0", "1,2", "1,2,3,4", "a,b,c", "1,2,inf", ""})
    expect_error(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--view=" + view}), 2);
  expect_error(reeb({"plot", "scan.ply"}), 1, "scan.ply: this is a mesh");
  std::filesystem::copy(in_folder("scan.ply"), in_folder("packed.ply.gz"));  // the name says so
  const Outcome packed = reeb({"plot", "packed.ply.gz"});
  expect_error(packed, 1, "packed.ply.gz: this is a mesh");
  EXPECT_EQ(lines_after("hint: ", packed.error).at(0), "first `reeb packed.ply.gz`, then `reeb plot packed.reeb`");
  expect_error(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--mesh", "scan.reeb", "-o", "a.svg"}), 1,
               "scan.reeb: this is a Reeb graph, not a mesh");
  expect_error(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--mesh", "-", "-o", "a.svg"}), 2);
  write("small.off", kSmallOff);
  expect_error(reeb({"plot", "scan.reeb", "--kind", "skeleton", "--mesh", "small.off", "-o", "a.svg"}), 1,
               "scan.reeb: this is not the graph of that mesh");
  // With as many vertices, too.
  const std::string whole = kSmallOff;
  write("open.off", "OFF\n4 3 0\n" + whole.substr(10, whole.rfind("3 0 3 2") - 10));
  expect_success(reeb({"compute", "small.off", "--quiet"}));
  expect_error(reeb({"plot", "small.reeb", "--kind", "skeleton", "--mesh", "open.off", "-o", "a.svg"}), 1,
               "small.reeb: this is not the graph of that mesh: it was computed from 4 triangles, the mesh has 3");
  // And the same surface in other units.
  write("moved.off", std::regex_replace(whole, std::regex("\n0 0 1\n"), "\n0 0 1000\n"));
  for (const std::string surface : {"solid", "none"}) {
    const Outcome moved =
        reeb({"plot", "small.reeb", "--kind", "skeleton", "--mesh", "moved.off", "--surface", surface, "-o", "a.svg"});
    expect_error(moved, 1, "moved.off: the node of vertex ");
    EXPECT_NE(moved.error.find("has another position in the mesh"), std::string::npos) << moved.error;
  }
}

TEST_F(Plot, OfAGraphAloneIsTheGraph) {
  expect_success(reeb({"compute", "scan.ply", "--graph-only", "-o", "only.reeb"}));
  expect_success(reeb({"plot", "only.reeb", "--kind", "skeleton", "-o", "a.svg"}));
  expect_error(reeb({"plot", "only.reeb", "--kind", "skeleton", "--nodes", "5", "-o", "b.svg"}), 1, "only.reeb: ");
}

TEST_F(Plot, OfAGraphAloneHasNoLoops) {
  REEB_NEEDS("gnuplot");
  expect_success(reeb({"compute", "scan.ply", "--graph-only", "-o", "only.reeb"}));
  expect_error(reeb({"plot", "only.reeb", "-o", "c.svg"}), 1, "only.reeb: the file has the graph only, no pairs");
}

// Many arcs become an image, so that the file stays small.
TEST_F(Plot, OfManyNodesIsAnImage) {
  expect_success(reeb({"generate", "terrain", "--triangles", "50k", "-o", "terrain.ply"}));
  expect_success(reeb({"compute", "terrain.ply", "-f", "random:1", "-o", "random.reeb"}));
  expect_success(reeb({"plot", "random.reeb", "--kind", "graph"}));
  expect_valid("random.svg");
  EXPECT_EQ(count_of("<image", file("random.svg")), 1u);
  expect_success(reeb({"plot", "random.reeb", "--kind", "skeleton", "--mesh", "terrain.ply", "-o", "s.svg"}));
  expect_valid("s.svg");
  EXPECT_EQ(count_of("class=\"key\"", file("s.svg")), 0u) << "a legend of marks that are not drawn";
}

TEST_F(Plot, OfManyPairsStaysSmall) {
  REEB_NEEDS("gnuplot");
  expect_success(reeb({"generate", "terrain", "--triangles", "50k", "-o", "terrain.ply"}));
  expect_success(reeb({"compute", "terrain.ply", "-f", "random:1", "-o", "random.reeb"}));
  expect_success(reeb({"plot", "random.reeb", "--kind", "diagram", "-o", "d.svg"}));
  expect_valid("d.svg");
}

// Of very many components of one node some are drawn, and the picture says how many are not.
TEST_F(Plot, OfManyIsolatedNodesDrawsSome) {
  std::string points = "OFF\n2000 0 0\n";
  for (int i = 0; i < 2000; ++i) points += "0 0 " + std::to_string(i % 10) + "\n";
  write("points.off", points);
  expect_success(reeb({"compute", "points.off", "-f", "z"}));
  expect_success(reeb({"plot", "points.reeb", "--kind", "graph"}));
  const std::string picture = file("points.svg");
  const std::size_t drawn = count_of("class=\"node\"", picture), missing = 2000 - drawn;
  EXPECT_GT(drawn, 100u);
  ASSERT_GT(missing, 1000u);
  const std::string number = "1," + std::to_string(missing).substr(1);
  EXPECT_EQ(count_of("; " + number + " of the components of one node or arc are not drawn", picture), 1u);
  EXPECT_EQ(count_of("2,000 isolated nodes", picture), 1u);
}

// A zigzag of edges, in which every vertex is a node. An end is cancelled with the fork next to it, which stays as
// a minimum, so a level can have an odd number of nodes.
TEST_F(Plot, OfTooManyNodesIsALevel) {
  std::string zigzag;
  for (int i = 0; i < 100'002; ++i) zigzag += "v " + std::to_string(i % 2 == 0 ? i + 2 : i) + "\n";
  for (int i = 0; i + 1 < 100'002; ++i) zigzag += "s " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
  write("zigzag.cx", zigzag);
  expect_success(reeb({"compute", "zigzag.cx", "-f", "x", "-o", "zigzag.reeb", "--buckets", "0"}));
  expect_success(reeb({"plot", "zigzag.reeb", "--kind", "graph", "-o", "level.svg"}));
  EXPECT_EQ(count_of("finest level of at most 100,000 nodes, 99,999 nodes, 99,998 arcs", file("level.svg")), 1u);
  expect_success(reeb({"plot", "zigzag.reeb", "--kind", "graph", "--threshold", "0", "-o", "all.svg"}));
  EXPECT_EQ(count_of("level at threshold 0, 100,002 nodes, 100,001 arcs", file("all.svg")), 1u);
}

}  // namespace
}  // namespace reeb::test
