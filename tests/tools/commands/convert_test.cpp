// Through the program: `reeb convert`, `reeb info` of meshes, and streams in `reeb compute`.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/io/streaming/samples.h"
#include "tests/support/data.h"
#include "tests/support/same.h"
#include "tests/tools/event_list.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using io::all_samples;
using io::golden_events;
using io::Sample;

class Convert : public testing::Test {
 protected:
  struct Outcome {
    int exit_code;
    std::string output, error;
  };

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string text(const std::string& name) const { return read_file(path(name)); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  // Runs the program with words for the shell, in a folder of its own.
  Outcome reeb(const std::string& words) const {
    const std::string command = "cd '" + folder_.string() + "' && '" REEB_PROGRAM "' " + words + " >stdout 2>stderr";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("stdout"), text("stderr")};
  }
  void expect_success(const std::string& words) const {
    const Outcome outcome = reeb(words);
    EXPECT_EQ(outcome.exit_code, 0) << words << '\n' << outcome.error;
  }
  EventList events_of(const std::string& mesh) const {
    expect_success("convert " + mesh + " listed.events.txt --force");
    return parse_events(text("listed.events.txt"));
  }
  nlohmann::json info_of(const std::string& mesh) const {
    return nlohmann::json::parse(reeb("info --json " + mesh).output);
  }
  // The counts of the graph that a run reports, as text.
  std::string graph_of(const std::string& words) const {
    const Outcome outcome = reeb("compute " + words + " -o graph.reeb --force --quiet --report -");
    EXPECT_EQ(outcome.exit_code, 0) << words << '\n' << outcome.error;
    return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.output)["graph"].dump() : "";
  }

  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("reeb-convert-" + std::to_string(::getpid()) + "-" +
                                                        testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

std::string sample(const std::string& file) { return test::sample_folder() + "/" + file; }

TEST_F(Convert, EverySampleGivesItsGoldenListOrItsClassOfError) {
  std::size_t good = 0, bad = 0;
  for (const Sample& s : all_samples()) {
    const Outcome outcome = reeb("convert " + sample(s.file) + " x.events.txt --force");
    if (s.good()) {
      ++good;
      EXPECT_EQ(outcome.exit_code, 0) << s.file << '\n' << outcome.error;
      EXPECT_TRUE(same(text("x.events.txt"), golden_events(s.file))) << s.file;
      std::filesystem::remove(path("x.events.txt"));
      continue;
    }
    ++bad;
    EXPECT_EQ(outcome.exit_code, 1) << s.file << '\n' << outcome.error;
    EXPECT_FALSE(std::filesystem::exists(path("x.events.txt"))) << s.file;
    // Gzip itself is no error: only damage inside it is reported.
    if (s.verdict.starts_with("any error") || s.file.ends_with(".gz")) continue;
    EXPECT_NE(outcome.error.find(": " + s.verdict + ": "), std::string::npos) << s.file << '\n' << outcome.error;
  }
  EXPECT_GT(good, 250u);
  EXPECT_GT(bad, 70u);
}

TEST_F(Convert, EveryVariantOfAStreamHasTheSameGraph) {
  for (const std::string name : {"torus", "nonmanifold", "twoparts", "mobius", "soup", "shuffled"}) {
    const std::string graph = graph_of(sample(name + ".pre.sma"));
    for (const char* variant : {".post.sma", ".le.smb", ".be-mislabelled.smb", ".post.be.smb", ".v1.smc", ".v3.smc"}) {
      const std::string file = sample(name + variant);
      ASSERT_TRUE(std::filesystem::exists(file)) << file;
      EXPECT_EQ(graph_of(file), graph) << file;
      EXPECT_EQ(graph_of("- < " + file), graph) << "standard input, " << file;
    }
    ASSERT_EQ(std::system(("gzip -c " + sample(name + ".v3.smc") + " > " + path("packed.gz")).c_str()), 0);
    EXPECT_EQ(graph_of("packed.gz"), graph) << name;
    EXPECT_EQ(graph_of("- < packed.gz"), graph) << name;
  }
  EXPECT_EQ(graph_of(sample("smalltorus-nofinal.v3-q12.smc")), graph_of(sample("smalltorus.v3-q12.smc")));
}

TEST_F(Convert, EachFormatReadBackHoldsTheSameMesh) {
  for (const std::string name : {"terrain", "soup", "twoparts"}) {
    const EventList before = parse_events(golden_events(name + ".pre.sma"));
    for (const std::string suffix : {"sma", "smb", "smc", "ply", "obj", "off"}) {
      expect_success("convert " + sample(name + ".pre.sma") + " there." + suffix + " --force");
      expect_success("convert there." + suffix + " back.sma --force");
      const EventList after = events_of("back.sma");
      EXPECT_TRUE(same(after.triangles(), before.triangles())) << name << " as " << suffix;
      EXPECT_TRUE(same(after.sorted_positions(), before.sorted_positions())) << name << " as " << suffix;
    }
  }
  // From stream to stream the list of events stays the same, including the values of vertices.
  for (const std::string file : {"terrain.pre.sma", "terrain.post.sma", "tetcube.s4.pre.sva", "tetcube.s4.post.sva"}) {
    const std::string block = file.ends_with(".sva") ? "x.svb" : "x.smb";
    expect_success("convert " + sample(file) + " " + block + " --force");
    expect_success("convert " + block + " x.events.txt --force");
    EXPECT_TRUE(same(text("x.events.txt"), golden_events(file))) << file;
  }
}

std::string as_stl(const EventList& mesh) {
  std::ostringstream out;
  out.precision(9);
  out << "solid terrain\n";
  for (const EventList::Event& event : mesh.events) {
    if (event.kind != 't') continue;
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::size_t v : event.vertices) {
      const auto& [x, y, z] = mesh.positions[v];
      out << "vertex " << x << ' ' << y << ' ' << z << '\n';
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid terrain\n";
  return out.str();
}

// Every format into every other. The list of its events says what the source mesh is. Triangles are compared by the
// positions of their corners, since some formats renumber vertices.
TEST_F(Convert, EveryFormatIntoEveryOther) {
  const std::vector<std::string> writable = {"ply", "obj", "off", "sma", "smb", "smc"};
  const std::string origin = sample("terrain.pre.sma");
  const EventList expected = parse_events(golden_events("terrain.pre.sma"));
  std::vector<std::string> sources = {origin, sample("terrain.post.sma"), sample("terrain.post.be.smb"),
                                      sample("terrain.be-mislabelled.smb"), sample("terrain.v1.smc")};
  for (const std::string& suffix : writable) {
    expect_success("convert " + origin + " source." + suffix);
    sources.push_back("source." + suffix);
  }
  write("source.stl", as_stl(expected));
  sources.push_back("source.stl");
  for (const std::string& source : sources)
    for (const std::string& suffix : writable)
      for (const std::string finalize : {"", " --finalize"}) {
        const std::string words = source + " there." + suffix + finalize;
        expect_success("convert " + words + " --force --memory 16M");
        const EventList mesh = events_of("there." + suffix);
        EXPECT_TRUE(same(mesh.triangles(), expected.triangles())) << words;
        EXPECT_TRUE(same(mesh.sorted_positions(), expected.sorted_positions())) << words;
        if (finalize.empty() || !suffix.starts_with("sm")) continue;
        EXPECT_EQ(check_compact(mesh).fault, "") << words;
        EXPECT_EQ(info_of("there." + suffix)["finalized_vertices"], expected.positions.size()) << words;
      }
}

TEST_F(Convert, AMeshWithoutVerticesCanBeReadBack) {
  write("none.off", "OFF\n0 0 0\n");
  for (const char* suffix : {"ply", "obj", "off", "cx", "sma", "smb", "smc", "sva", "svb"}) {
    expect_success(std::string("convert none.off none-back.") + suffix);
    EXPECT_EQ(info_of(std::string("none-back.") + suffix)["vertices"], 0) << suffix;
  }
}

// A surface format gets the four faces of a tetrahedron, in any order. Values are kept where the format can store them.
TEST_F(Convert, VolumesKeepTheirGraphsAndTheValuesOfTheirVertices) {
  const std::string volume = sample("tetcube.s4.pre.sva");
  const std::string height = graph_of(volume + " -f z"), value = graph_of(volume + " -f property:s0");
  EXPECT_NE(height, value) << "a test that could not fail";
  for (const std::string variant : {"tetcube.s4.post.sva", "tetcube.s4.pre.be.svb", "tetcube.s4.post.le.svb"}) {
    EXPECT_EQ(graph_of(sample(variant) + " -f property:s0"), value) << variant;
    EXPECT_EQ(graph_of("- -f property:s0 < " + sample(variant)), value) << "standard input, " << variant;
  }
  for (const std::string target : {"a.svb", "a.sva", "a.ply"}) {
    expect_success("convert " + volume + " " + target);
    EXPECT_EQ(graph_of(target + " -f property:s0"), value) << target;
  }
  for (const std::string order : {"keep", "hilbert", "spectral", "sweep:z", "sweep:property:s0"})
    for (const std::string target : {"b.ply", "b.smb", "b.smc"}) {
      expect_success("convert " + volume + " " + target + " --force --order " + order);
      EXPECT_EQ(info_of(target)["triangles"], 4 * info_of(volume)["tetrahedra"].get<int>()) << order << ' ' << target;
      if (target == "b.ply") {
        EXPECT_EQ(graph_of("b.ply -f property:s0"), value) << order;
      }
    }
  const Outcome absent = reeb("compute " + volume + " -f property:s1");
  EXPECT_EQ(absent.exit_code, 1);
  EXPECT_NE(absent.error.find("hint: it has these: s0"), std::string::npos) << absent.error;
  for (const std::string option : {"--finalize", "--order hilbert"}) {
    const Outcome refused = reeb("convert " + volume + " c.svb " + option);
    EXPECT_EQ(refused.exit_code, 2) << option;
    EXPECT_NE(refused.error.find("volume meshes are converted in their own order only"), std::string::npos)
        << refused.error;
  }
}

TEST_F(Convert, SaysThatOtherSimplicesBecomeTriangles) {
  write("mixed.cx", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 2 2\nv 3 3 3\ns 0 1 2 3\ns 4\ns 3 5\n");
  const std::string low = "points and edges (2) are written as triangles with repeated corners",
                    high = "simplices of more than three corners (1) are written as their triangles";
  struct Case {
    std::string output;
    bool says_low, says_high;
  };
  for (const auto& [output, says_low, says_high] :
       {Case{"o.cx", true, true}, {"o.ply", true, false}, {"o.events.txt", false, true}, {"o.smb", false, false}})
    for (const std::string option : {"", "--finalize", "--order hilbert"}) {
      SCOPED_TRACE(output + ' ' + option);
      const Outcome done = reeb("convert mixed.cx " + output + " --force " + option);
      EXPECT_EQ(done.exit_code, 0) << done.error;
      EXPECT_EQ(done.error.find(low) != std::string::npos, says_low && !option.empty()) << done.error;
      EXPECT_EQ(done.error.find(high) != std::string::npos, says_high && !option.empty()) << done.error;
      if (option.empty() && output == "o.cx") {
        EXPECT_EQ(info_of(output)["simplices"], info_of("mixed.cx")["simplices"]);
      }
    }
}

TEST_F(Convert, EveryOrderIsACompactStreamOfTheSameTriangles) {
  expect_success("generate scan --triangles 20000 --order random --seed 5 -o scan.ply");
  const EventList input = events_of("scan.ply");
  std::map<std::string, std::size_t> width;
  for (const std::string order : {"keep", "hilbert", "spectral", "sweep:z", "sweep:random:3"}) {
    expect_success("convert scan.ply out.events.txt --force --finalize --memory 16M --order " + order);
    const EventList output = parse_events(text("out.events.txt"));
    EXPECT_TRUE(same(output.triangles(), input.triangles())) << order;
    EXPECT_TRUE(same(output.sorted_positions(), input.sorted_positions())) << order;
    const CompactStream stream = check_compact(output);
    EXPECT_EQ(stream.fault, "") << order;
    width[order] = stream.front_width;
    for (const std::string suffix : {"smb", "smc"}) {
      expect_success("convert scan.ply out." + suffix + " --force --finalize --memory 16M --order " + order);
      const auto info = info_of("out." + suffix);
      EXPECT_EQ(info["live_front"], stream.front_width) << order << ' ' << suffix;
      EXPECT_EQ(info["finalized_vertices"], input.positions.size()) << order << ' ' << suffix;
    }
  }
  EXPECT_LT(width["hilbert"] * 5, width["keep"]);
  EXPECT_LT(width["sweep:z"] * 5, width["sweep:random:3"]);
  EXPECT_LE(width["spectral"], width["hilbert"]);
}

TEST_F(Convert, ListsOfEventsRestoreEveryNumber) {
  write("double.obj", "v 0.123456789 1e-300 -0.1\nv 16777217 0.3333333333333333 0\nv 0 1 0.5\nf 1 2 3\n");
  const std::string vertices = "v 0 0.123456789 1e-300 -0.1\nv 1 16777217 0.3333333333333333 0\nv 2 0 1 0.5\n";
  expect_success("convert double.obj plain.events.txt");
  EXPECT_EQ(text("plain.events.txt"), vertices + "t 0 1 2\n");
  expect_success("convert double.obj compact.events.txt --finalize");
  EXPECT_EQ(text("compact.events.txt"), vertices + "t 0 1 2\nf 0\nf 1\nf 2\n");
  // Nine digits restore a float32.
  write("single.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n0.123456789 0.5 -2\n");
  for (const std::string option : {"", " --finalize"}) {
    expect_success("convert single.ply single.events.txt --force" + option);
    EXPECT_TRUE(text("single.events.txt").starts_with("v 0 0.123456791 0.5 -2\n")) << option;
  }
}

TEST_F(Convert, AListOfEventsThatCannotBeWrittenIsAnError) {
  std::filesystem::create_symlink("/dev/full", path("full.events.txt"));
  write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome outcome = reeb("convert one.obj full.events.txt --force");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.error;
  EXPECT_NE(outcome.error.find("full.events.txt"), std::string::npos) << outcome.error;
}

// All cells wait for their vertices, 12 bytes each at least.
// SMC leaves out the two vertices in no triangle, but its head announces all 14.
TEST_F(Convert, CountsOfAHeadAreThoseOfTheStream) {
  expect_success("convert " + sample("vertsfirst.le.smb") + " a.smc --force");
  const auto announces = [&](const std::string& mesh) {
    const Outcome outcome = reeb("compute " + mesh + " -o announced.reeb --force");
    EXPECT_EQ(outcome.exit_code, 0) << mesh << outcome.error;
    EXPECT_EQ(outcome.error.find("COUNT"), std::string::npos) << mesh << outcome.error;
    return nlohmann::json::parse(reeb("info --json " + mesh).output)["vertices"];
  };
  for (const std::string suffix : {".sma", ".smb", ".smc"}) {
    expect_success("convert a.smc again" + suffix);
    EXPECT_EQ(announces("again" + suffix), 12) << suffix;
    expect_success("convert - piped" + suffix + " <a.smc");
    EXPECT_EQ(announces("piped" + suffix), 12) << suffix;
  }
  expect_success("convert " + sample("tetra.more-than-promised.pre.sma") + " more.smb");
  EXPECT_EQ(announces("more.smb"), 4);
}

TEST_F(Convert, ACommentIsNoKeywordInAnotherFormat) {
  const std::string body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  // SMB: byte order, reserved, one comment, counts, no box, the elements v v v f.
  for (const std::string comment :
       {"nverts by laser scan", "svtype tet", "nfaces 77", "v_pnum_f 4", "bb_min is wrong"}) {
    std::string bytes(4, '\0');
    const auto put = [&bytes](auto word) { bytes.append(reinterpret_cast<const char*>(&word), sizeof word); };
    put(std::uint32_t{1});
    put(static_cast<std::uint32_t>(comment.size()));
    bytes += comment;
    put(std::uint32_t{3});
    put(std::uint32_t{1});
    bytes += '\0';
    put(std::uint32_t{0b0111});
    for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) put(x);
    for (const std::int32_t corner : {1, 2, 3}) put(corner);
    write("c.smb", bytes);
    expect_success("convert c.smb c.sma --force");
    const nlohmann::json info = info_of("c.sma");
    EXPECT_EQ(info["vertices"], 3) << comment;
    EXPECT_EQ(info["simplices"][2], 1) << comment;
    EXPECT_NE(text("c.sma").find(comment), std::string::npos);
  }
  for (const std::string comment : {"# v_precision 9", "# c_path /data", "# ncells 100"}) {
    write("c.sma", comment + "\n" + body);
    EXPECT_EQ(info_of("c.sma")["simplices"][2], 1) << comment;
  }
  write("c.obj", "# v_precision 9\n" + body);
  EXPECT_EQ(info_of("c.obj")["format"], "OBJ");
  // A keyword may come after a count that is one only with it.
  write("c.sva", "# nfaces 9\n# ncells 2\n# svtype tet\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nc 1 2 3 4\n");
  EXPECT_NE(reeb("info c.sva").error.find("TRUNCATED: file ends after 1 of 2"), std::string::npos);
  write("named", text("c.sva"));
  EXPECT_NE(reeb("info named").error.find("TRUNCATED: file ends after 1 of 2"), std::string::npos);
  write("named", "# nfaces 9\n# svtype tet\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nc 1 2 3 4\n");
  EXPECT_EQ(info_of("named")["simplices"][3], 1);
}

TEST_F(Convert, ABoxThatIsNoneIsLeftOut) {
  write("box.sma", "# bb_min 5 5 5\n# bb_max 0 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string suffix : {".smb", ".smc", ".sma"}) {
    expect_success("convert box.sma boxed" + suffix);
    EXPECT_EQ(info_of("boxed" + suffix)["simplices"][2], 1) << suffix;
  }
}

TEST_F(Convert, APostOrderStreamThatDoesNotFitIntoMemoryIsAnError) {
  std::string stream;
  for (int i = 0; i < 400000; ++i) stream += "f 1 2 3\n";
  write("late.sma", stream + "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  for (const std::string command :
       {"compute late.sma -o late.reeb --quiet", "info late.sma", "convert late.sma late.smc --quiet",
        "convert late.sma late.ply --quiet", "function late.sma -f z -o late.f64 --quiet"}) {
    const Outcome outcome = reeb(command + " --memory 16M");
    EXPECT_EQ(outcome.exit_code, 3) << command << outcome.error;
    EXPECT_NE(outcome.error.find("mesh reader"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("--memory"), std::string::npos) << outcome.error;
  }
}

// A reader of STL keeps all vertices: 24 bytes for each, and at least 16 to find it.
TEST_F(Convert, AnStlFileWhoseVerticesDoNotFitIntoMemoryIsAnError) {
  constexpr std::uint32_t kFacets = 150'000;
  std::string stl(84, '\0');
  std::memcpy(stl.data() + 80, &kFacets, sizeof(kFacets));
  for (std::uint32_t i = 0; i < kFacets; ++i) {
    const float at = static_cast<float>(i);
    const float facet[12] = {0, 0, 0, at, 0, 0, at, 1, 0, at, 0, 1};  // the normal, and three corners of its own
    stl.append(reinterpret_cast<const char*>(facet), sizeof(facet)).append(2, '\0');
  }
  write("large.stl", stl);
  for (const std::string output : {"out.ply", "out.smb", "out.f64"}) {
    const bool is_mesh = output != "out.f64";
    const std::string command = (is_mesh ? "convert large.stl " : "function large.stl -f z -o ") + output + " --quiet";
    const Outcome outcome = reeb(command + " --memory 16M");
    EXPECT_EQ(outcome.exit_code, 3) << command << outcome.error;
    EXPECT_NE(outcome.error.find("mesh reader"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("hint: allow more, for instance --memory "), std::string::npos) << outcome.error;
    EXPECT_FALSE(std::filesystem::exists(path(output)));
    expect_success(command + " --memory 64M");
  }
}

TEST_F(Convert, IsolatedVerticesAndDegenerateTrianglesSurviveFinalization) {
  write("odd.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 2 3 4\nf 2 3\nf 4 3 4\n");
  expect_success("convert odd.obj odd.events.txt --finalize");
  const EventList list = parse_events(text("odd.events.txt"));
  EXPECT_EQ(check_compact(list).fault, "");
  EXPECT_EQ(list.positions.size(), 5u);
  EXPECT_EQ(list.triangles().size(), 3u);
  expect_success("convert odd.obj odd.smb --finalize");
  EXPECT_EQ(graph_of("odd.smb"), graph_of("odd.obj"));
  const Outcome refused = reeb("convert odd.obj odd.smc");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.error.find("repeated corner"), std::string::npos) << refused.error;
  EXPECT_FALSE(std::filesystem::exists(path("odd.smc")));
}

TEST_F(Convert, CompressedStreamOfARealMeshIsLossless) {
  REEB_REQUIRE_MESHES();
  const std::string mesh = mesh_folder() + "/dragon_vrip.ply.gz";
  expect_success("convert " + mesh + " dragon.smc");
  const EventList before = events_of(mesh), after = events_of("dragon.smc");
  EXPECT_TRUE(same(after.triangles(), before.triangles()));
  EXPECT_TRUE(same(after.sorted_positions(), before.sorted_positions()));
  EXPECT_EQ(after.positions.size(), 437645u);
}

TEST_F(Convert, KeepsDoublePrecisionWhereTheInputHasIt) {
  write("fine.obj", "v 0.1 0.2 0.3\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_success("convert fine.obj fine.ply");
  EXPECT_NE(text("fine.ply").find("property double x"), std::string::npos);
  const Outcome rounded = reeb("convert fine.obj fine.sma");
  EXPECT_NE(rounded.error.find("rounded to float32, which is what streaming meshes hold: 1 vertex\n"),
            std::string::npos)
      << rounded.error;
}

// What comes through a pipe can be opened only once.
TEST_F(Convert, ValuesOfVerticesComeThroughAPipe) {
  expect_success("convert " + sample("tetcube.s4.pre.sva") + " file.ply");
  ASSERT_NE(text("file.ply").find("property float s0"), std::string::npos);
  expect_success("convert file.ply expected.ply");
  expect_success("convert - input.ply < file.ply");
  EXPECT_TRUE(same(text("input.ply"), text("expected.ply")));
  for (const std::string target : {"pipe.ply", "pipe.ply --finalize --force"}) {
    const std::string command = "cd '" + folder_.string() +
                                "' && rm -f fifo && mkfifo fifo && (cat file.ply > fifo & timeout 20 '" REEB_PROGRAM
                                "' convert fifo " +
                                target + " >stdout 2>stderr)";
    ASSERT_EQ(std::system(command.c_str()), 0) << target << '\n' << text("stderr");
    EXPECT_EQ(graph_of("pipe.ply -f property:s0"), graph_of("file.ply -f property:s0")) << target;
  }
  EXPECT_NE(text("pipe.ply").find("property float s0"), std::string::npos);
}

TEST_F(Convert, RefusesWhatItCannotDo) {
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("taken.smb", "mine");
  EXPECT_EQ(reeb("convert a.obj taken.smb").exit_code, 1);
  EXPECT_EQ(text("taken.smb"), "mine");
  expect_success("convert a.obj taken.smb --force");
  EXPECT_EQ(reeb("convert a.obj b.xyz").exit_code, 2);
  EXPECT_EQ(reeb("convert a.obj b.smb --order up").exit_code, 2);
  EXPECT_EQ(reeb("convert a.obj b.svb").exit_code, 1) << "triangles in a volume mesh";
  for (const std::string number : {"0", "-3", "many"}) {
    const Outcome refused = reeb("compute a.obj --snapshot-every " + number);
    EXPECT_EQ(refused.exit_code, 2) << number;
    EXPECT_NE(refused.error.find("error: --snapshot-every"), std::string::npos) << refused.error;
  }
  EXPECT_EQ(reeb("convert a.obj nowhere/b.smb").exit_code, 3);
}

TEST_F(Convert, InfoSaysWhatAMeshHolds) {
  write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 5 5\nv 5 6 5\nv 7 7 7\nf 1 2 3\nf 4 5 6\nf 4 4 5\n");
  const auto info = info_of("two.obj");
  EXPECT_EQ(info["vertices"], 7);
  EXPECT_EQ(info["triangles"], 3);
  EXPECT_EQ(info["degenerate"]["count"], 1);
  EXPECT_EQ(info["unreferenced_vertices"], 1);
  EXPECT_EQ(info["components"]["count"], 3);
  EXPECT_EQ(info["finalization"], false);
  EXPECT_EQ(info["bounds"][0]["max"], 7.0);
  EXPECT_EQ(info["live_front"], 2) << "vertices 4 and 5 wait for the last triangle";
  EXPECT_NE(reeb("info two.obj").output.find("components    3"), std::string::npos);
}

TEST_F(Convert, SnapshotsAreTheGraphsOfTheStreamSoFar) {
  constexpr std::size_t kEvery = 100;
  expect_success("compute - --snapshot-every 100 -f y -o live.reeb --quiet < " + sample("torus.v3.smc"));
  std::istringstream events(golden_events("torus.v3.smc"));
  std::string prefix, line;
  std::size_t triangles = 0, snapshots = 0;
  while (std::getline(events, line)) {
    std::istringstream words(line);
    char kind = 0;
    std::string numbers[4];
    words >> kind >> numbers[0] >> numbers[1] >> numbers[2] >> numbers[3];
    if (kind == 'v') prefix += "v " + numbers[1] + " " + numbers[2] + " " + numbers[3] + "\n";
    if (kind != 't') continue;
    prefix += "f";
    for (int c = 0; c < 3; ++c) prefix.append(1, ' ').append(std::to_string(std::stoul(numbers[c]) + 1));
    prefix += "\n";
    if (++triangles % kEvery != 0) continue;
    write("prefix.sma", prefix);
    expect_success("compute prefix.sma -f y -o prefix.reeb --graph-only --quiet --force");
    expect_success("extract prefix.reeb -o prefix.rg --force");
    const std::string name = "live-00000" + std::to_string(++snapshots);
    expect_success("verify " + name + ".reeb");
    expect_success("extract " + name + ".reeb -o " + name + ".rg");
    EXPECT_EQ(text(name + ".rg"), text("prefix.rg")) << name;
  }
  EXPECT_EQ(snapshots, 3u);
  EXPECT_FALSE(std::filesystem::exists(path("live-000004.reeb")));
  expect_success("verify live.reeb");
}

}  // namespace
}  // namespace reeb::test
