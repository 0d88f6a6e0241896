// `reeb fragment` and `reeb glue`: the same bytes as one run, and what is said of fragments that do not fit.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "io/file/checksum.h"
#include "tests/support/data.h"
#include "tests/support/same.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class FragmentTest : public ProgramTest {
 protected:
  using Words = std::vector<std::string>;

  static Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  // The fragments of all parts, in order.
  Words fragments(const std::string& mesh, unsigned parts, const Words& options = {}) {
    Words names;
    for (unsigned part = 1; part <= parts; ++part) {
      names.push_back(name_of(std::to_string(part), ".fragment"));
      const std::string which = std::to_string(part) + "/" + std::to_string(parts);
      expect_success(
          reeb(with({"fragment", mesh, "--part", which, "-o", names.back(), "--quiet", "--force"}, options)));
    }
    return names;
  }

  void expect_same(const std::string& mesh, const Words& options, unsigned parts) {
    SCOPED_TRACE(mesh + " in " + std::to_string(parts));
    expect_success(reeb(with({"compute", mesh, "-o", "one.reeb", "--quiet", "--force"}, options)));
    const Words names = fragments(mesh, parts, options);
    expect_success(reeb(with({"glue", "-o", "all.reeb", "--quiet", "--force"}, names)));
    EXPECT_TRUE(same(file("all.reeb"), file("one.reeb"))) << "as a list";
    // Two of the last, then the rest in reverse order.
    if (parts < 3) return;
    expect_success(reeb({"glue", names[parts - 1], names[0], "-o", "some.fragment", "--quiet", "--force"}));
    Words rest{"glue", "some.fragment", "-o", "all.reeb", "--quiet", "--force"};
    for (unsigned part = parts - 1; part-- > 1;) rest.push_back(names[part]);
    expect_success(reeb(rest));
    EXPECT_TRUE(same(file("all.reeb"), file("one.reeb"))) << "in groups";
    // Neighbours in pairs, then these in pairs.
    Words row = names;
    for (unsigned level = 0; row.size() > 2; ++level) {
      Words above;
      for (std::size_t i = 0; i < row.size(); i += 2) {
        above.push_back(i + 1 == row.size() ? row[i] : std::to_string(level) + "-" + std::to_string(i) + ".fragment");
        if (i + 1 < row.size())
          expect_success(reeb({"glue", row[i], row[i + 1], "-o", above.back(), "--quiet", "--force"}));
      }
      row = above;
    }
    expect_success(reeb(with({"glue", "-o", "all.reeb", "--quiet", "--force"}, row)));
    EXPECT_TRUE(same(file("all.reeb"), file("one.reeb"))) << "as a tree";
  }

  // "2/3" -> "p2.fragment"
  static std::string name_of(const std::string& part, const char* suffix) {
    return std::string{'p', part[0]}.append(suffix);
  }

  void make_scan(const std::string& name, const std::string& triangles, const std::string& order = "patches") {
    expect_success(reeb({"generate", "scan", "--triangles", triangles, "--order", order, "-o", name}));
  }
};

TEST_F(FragmentTest, GivesTheSameBytesAsOneRun) {
  make_scan("scan.ply", "8k");
  const Words plain{"--buckets", "0"};
  for (const unsigned parts : {1u, 2u, 3u, 8u}) expect_same("scan.ply", plain, parts);
  expect_same("scan.ply", with(plain, {"--denoise", "1%"}), 3);
  expect_same("scan.ply", with(plain, {"--denoise", "0.01"}), 3);
  expect_same("scan.ply", with(plain, {"--graph-only", "-f", "random:1"}), 3);
}

TEST_F(FragmentTest, TakesOrdersAndFormatsOfAllKinds) {
  const Words plain{"--buckets", "0"};
  make_scan("random.ply", "4k", "random");
  make_scan("rows.ply", "4k", "rows");
  make_scan("scan.obj", "2k");
  make_scan("scan.smc", "2k");
  expect_success(reeb({"generate", "ball", "--tetrahedra", "500", "-o", "ball.cx"}));
  expect_success(reeb({"generate", "volume", "--grid", "6x5x4", "-o", "volume.nrrd"}));
  for (const char* mesh : {"random.ply", "rows.ply", "scan.obj", "scan.smc", "ball.cx", "volume.nrrd"})
    expect_same(mesh, plain, 3);
  // More parts than triangles; vertices without a triangle, and no triangle at all.
  write("small.off", kSmallOff);
  write("points.cx", "v 1\nv 0\nv 2\nv 2\n");
  write("none.cx", "# nothing\n");
  for (const char* mesh : {"small.off", "points.cx", "none.cx"}) expect_same(mesh, plain, 5);
}

// With REEB_TEST_ALL=1, all of them, in as many ways as there are: minutes.
TEST_F(FragmentTest, TakesRealMeshes) {
  REEB_REQUIRE_MESHES();
  const bool all = std::getenv("REEB_TEST_ALL") != nullptr;
  const std::set<std::string> some{"cow.obj", "post_tets.vtk"}, beside{".md", ".tsv"};
  std::size_t meshes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(mesh_folder())) {
    if (!all && !some.contains(entry.path().filename().string())) continue;
    if (beside.contains(entry.path().extension().string())) continue;
    ++meshes;
    for (const unsigned parts : {1u, 2u, 3u, 5u, 8u})
      if (all || parts == 3) expect_same(entry.path().string(), {"--buckets", "0"}, parts);
  }
  EXPECT_GE(meshes, all ? 20u : some.size()) << "in " << mesh_folder();
}

// Fronts of thousands of vertices: long rows, and no order at all.
TEST_F(FragmentTest, TakesWideFronts) {
  expect_success(reeb({"generate", "grid", "--triangles", "40k", "--width", "4000", "-o", "rows.ply"}));
  make_scan("random.ply", "20k", "random");
  for (const char* mesh : {"rows.ply", "random.ply"})
    for (const unsigned parts : {2u, 5u}) expect_same(mesh, {"--buckets", "0", "--graph-only"}, parts);
  expect_same("rows.ply", {"--buckets", "0", "--graph-only", "-f", "random:2"}, 3);
}

TEST_F(FragmentTest, OutputsAreNamedAfterTheMeshAndThePart) {
  std::filesystem::create_directory(in_folder("meshes"));
  write("meshes/small.off", kSmallOff);
  expect_success(reeb({"fragment", "meshes/small.off", "--part", "2/3", "--quiet"}));
  expect_success(reeb({"fragment", "meshes/small.off", "--part", "2/3", "--scan", "--quiet"}));
  EXPECT_EQ(files(), (Words{"meshes", "small-2-of-3.fragment", "small-2-of-3.names"}));
  expect_success(reeb({"fragment", "meshes/small.off", "--part", "2/3", "-f", "x", "-f", "z", "--quiet"}));
  EXPECT_EQ(files(), (Words{"meshes", "small-2-of-3-x.fragment", "small-2-of-3-z.fragment", "small-2-of-3.fragment",
                            "small-2-of-3.names"}));
}

// Where a file has the size of one of triangles, a part goes to its share without reading what is before. An edge and
// a quadrilateral have that size, too.
TEST_F(FragmentTest, CountsWhatOnlyHasTheSizeOfTriangles) {
  std::string mesh =
      "ply\nformat binary_little_endian 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const auto add = [&](const auto& value) { mesh.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const float z : {0.f, 2.f, 1.f, 4.f, 3.f, 5.f})
    for (const float coordinate : {z * z, 1.f, z}) add(coordinate);
  const std::vector<std::vector<std::int32_t>> faces = {{0, 1, 2}, {1, 2, 3, 4}, {4, 5}, {2, 3, 5}};
  for (const auto& face : faces) {
    add(static_cast<std::uint8_t>(face.size()));
    for (const std::int32_t corner : face) add(corner);
  }
  write("odd.ply", mesh);
  for (const unsigned parts : {1u, 2u, 3u, 5u}) expect_same("odd.ply", {"--buckets", "0"}, parts);
  expect_error(reeb({"fragment", "odd.ply", "--scan", "--part", "1/2", "-o", "p1.names"}), 1,
               "odd.ply: not all of its faces are triangles, although together they have the size of triangles");
  // Damage is named as by other commands, whatever part it is in.
  make_scan("scan.ply", "2k");
  std::string damaged = file("scan.ply");
  damaged[damaged.size() - 5] = '\x7f';  // a corner of the last triangle
  write("scan.ply", damaged);
  const Outcome computed = reeb({"compute", "scan.ply", "-o", "x.reeb"});
  expect_error(computed, 1);
  for (const char* part : {"1/2", "2/2"}) {
    const Outcome fragment = reeb({"fragment", "scan.ply", "--part", part, "-o", "p.fragment"});
    expect_error(fragment, 1);
    EXPECT_EQ(lines_after("reeb: error: ", fragment.error), lines_after("reeb: error: ", computed.error));
  }
}

std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

void set_number(std::string& bytes, std::size_t at, std::uint64_t number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

std::uint64_t checksum_of(const std::string& bytes, std::size_t begin, std::size_t count) {
  return io::checksum(std::as_bytes(std::span(bytes).subspan(begin, count)));
}

// A fragment whose first block of nodes is there so many times. All checksums are right (docs/FORMAT.md).
std::string with_nodes(std::string bytes, int times) {
  constexpr std::size_t kHeader = 40, kFixed = 16 * 8;
  const std::size_t state = number_at(bytes, 16), blocks = kHeader + state;
  std::size_t at = kHeader + kFixed;
  at += 16 + number_at(bytes, at) + 5 * 8;      // the name of the function, and what follows it
  at += 16 + 8 * number_at(bytes, at) + 2 * 8;  // the runs and the range
  const std::size_t nodes = at + 3 * 8;         // the number of settled nodes
  const std::size_t size = 32 + number_at(bytes, blocks + 16);
  EXPECT_EQ(number_at(bytes, blocks), 1u) << "a block of nodes";
  const std::string block = bytes.substr(blocks, size);
  const auto more = static_cast<std::uint64_t>(times - 1) * number_at(block, 8);
  set_number(bytes, nodes, number_at(bytes, nodes) + more);
  bytes.erase(blocks, size);
  for (int i = 0; i < times; ++i) bytes.insert(blocks, block);
  set_number(bytes, 24, checksum_of(bytes, kHeader, state));
  set_number(bytes, 32, checksum_of(bytes, 0, 32));
  return bytes;
}

TEST_F(FragmentTest, WhatSettledIsNotTrusted) {
  make_scan("scan.ply", "20k");
  const Words names = fragments("scan.ply", 2);
  const std::string good = file(names[0]);
  const Words glue = with({"glue", "-o", "all.reeb", "--quiet", "--force"}, names);
  write(names[0], with_nodes(good, 1));
  expect_success(reeb(glue));
  for (const auto& [times, why] : {std::pair(0, "which is not a node"), std::pair(2, "is a node twice")})
    for (const Words& options : {Words{}, Words{"--graph-only"}, Words{"--memory", "64M"}}) {
      write(names[0], with_nodes(good, times));
      const Outcome outcome = reeb(with(glue, options));
      expect_error(outcome, 1, "the fragments are damaged, or do not belong together: ");
      const bool says_why = outcome.error.find(why) != std::string::npos;
      EXPECT_TRUE(says_why || options == Words{"--graph-only"}) << outcome.error;
    }
}

TEST_F(FragmentTest, IsNamedByOtherCommands) {
  make_scan("scan.ply", "2k");
  fragments("scan.ply", 3);
  const Outcome text = reeb({"info", "p2.fragment"});
  expect_success(text);
  EXPECT_TRUE(text.output.starts_with("p2.fragment: fragment, part 2 of 3, ")) << text.output;
  expect_success(reeb({"glue", "p1.fragment", "p3.fragment", "-o", "some.fragment", "--quiet"}));
  const Outcome json = reeb({"info", "some.fragment", "--json"});
  expect_success(json);
  for (const char* field : {"\"format\": \"fragment\"", "\"of_parts\": 3", "\"name\": \"z\"", "\"open_vertices\": "})
    EXPECT_NE(json.output.find(field), std::string::npos) << field << json.output;
  expect_error(reeb({"compute", "p2.fragment", "-o", "x.reeb"}), 1, "p2.fragment:0: this is a fragment, not a mesh");
  for (const char* command : {"extract", "pairs"})
    expect_error(reeb({command, "p2.fragment", "-o", "x.csv"}), 1, "p2.fragment: this is a fragment, not a Reeb graph");
  expect_success(reeb({"fragment", "scan.ply", "--scan", "--part", "1/2", "-o", "p1.names", "--quiet"}));
  expect_error(reeb({"compute", "p1.names", "-o", "x.reeb"}), 1, "p1.names:0: this is a file of names");
  expect_error(reeb({"glue", "p1.fragment", "none.fragment", "-o", "x.reeb"}), 1,
               "none.fragment: there is no such file");
}

TEST_F(FragmentTest, KeepsEveryVertexOfTheEmbedding) {
  make_scan("scan.ply", "4k");
  const Words names = fragments("scan.ply", 3);
  expect_success(reeb(with({"glue", "-o", "all.reeb", "--quiet"}, names)));
  expect_success(reeb({"verify", "all.reeb", "--mesh", "scan.ply"}));
  expect_success(reeb(with({"glue", "-o", "bare.reeb", "--buckets", "0", "--quiet"}, names)));
  expect_success(reeb({"compute", "scan.ply", "-o", "one.reeb", "--buckets", "0", "--quiet"}));
  EXPECT_TRUE(same(file("bare.reeb"), file("one.reeb")));
}

TEST_F(FragmentTest, ComputesSeveralFunctionsInOneReading) {
  make_scan("scan.ply", "2k");
  for (const char* part : {"1/2", "2/2"})
    expect_success(reeb({"fragment", "scan.ply", "--part", part, "-f", "x", "-f", "y", "--buckets", "0", "--quiet",
                         "-o", name_of(part, ".fragment")}));
  for (const char* function : {"x", "y"}) {
    const std::string f = function;
    expect_success(reeb({"glue", "p2-" + f + ".fragment", "p1-" + f + ".fragment", "-o", f + ".reeb", "--quiet"}));
    expect_success(reeb({"compute", "scan.ply", "-f", f, "--buckets", "0", "-o", "one.reeb", "--quiet", "--force"}));
    EXPECT_TRUE(same(file(f + ".reeb"), file("one.reeb"))) << f;
  }
}

TEST_F(FragmentTest, LearnsFromNamesAndFromTheSidecar) {
  make_scan("scan.ply", "20k");
  for (const char* part : {"1/3", "2/3", "3/3"})
    expect_success(reeb({"fragment", "scan.ply", "--scan", "--part", part, "--quiet", "-o", name_of(part, ".names")}));
  const Words names{"--buckets", "0", "--shared", "p3.names", "p1.names", "p2.names"};
  const Words parts = fragments("scan.ply", 3, names);
  expect_success(reeb({"compute", "scan.ply", "--buckets", "0", "--sidecar", "-o", "one.reeb", "--quiet"}));
  expect_success(reeb(with({"glue", "-o", "all.reeb", "--quiet"}, parts)));
  EXPECT_TRUE(same(file("all.reeb"), file("one.reeb")));
  // One part of the sidecar, the others of the names.
  expect_success(
      reeb({"fragment", "scan.ply", "--part", "2/3", "--buckets", "0", "-o", parts[1], "--quiet", "--force"}));
  expect_success(reeb(with({"glue", "-o", "all.reeb", "--quiet", "--force"}, parts)));
  EXPECT_TRUE(same(file("all.reeb"), file("one.reeb")));
  expect_error(reeb({"fragment", "scan.ply", "--part", "1/3", "--shared", "p1.names", "p3.names", "-o", "x.fragment"}),
               1, "p1.names: the names of part 2 of 3 are missing");
  write("p2.names", file("p2.names").substr(0, 100));
  expect_error(
      reeb(with({"fragment", "scan.ply", "--part", "1/3", "-o", "x.fragment"}, {names.begin() + 2, names.end()})), 1,
      "p2.names:100: this file of names was cut off");
}

TEST_F(FragmentTest, SaysWhichFragmentDoesNotFitAndWhy) {
  make_scan("scan.ply", "2k");
  const Words names = fragments("scan.ply", 3, {"--buckets", "0"});
  const Words glue{"glue", "-o", "all.reeb", "--quiet"};
  expect_error(reeb(with(glue, {names[0], names[2]})), 1, "p1.fragment: part 2 of 3 is missing");
  std::filesystem::copy_file(in_folder("p2.fragment"), in_folder("again.fragment"));
  expect_error(reeb(with(glue, with(names, {"again.fragment"}))), 1,
               "again.fragment: part 2 of 3 is here a second time");
  make_scan("other.ply", "3k");
  const auto other = [&](const std::string& mesh, const std::string& part, const Words& options,
                         const std::string& why) {
    expect_success(reeb(with({"fragment", mesh, "--part", part, "-o", "o.fragment", "--quiet", "--force"}, options)));
    expect_error(reeb(with(glue, {names[0], "o.fragment", names[2]})), 1, "o.fragment: this fragment " + why);
  };
  other("other.ply", "2/3", {"--buckets", "0"}, "is of another mesh");
  other("scan.ply", "2/3", {"--buckets", "0", "-f", "x"}, "is of another function, x");
  other("scan.ply", "2/4", {"--buckets", "0"}, "is of 4 parts, not of 3");
  other("scan.ply", "2/3", {}, "was made with another number of --buckets");
  other("scan.ply", "2/3", {"--buckets", "0", "--denoise", "1%"}, "was made with another --denoise");
  other("scan.ply", "2/3", {"--buckets", "0", "--graph-only"}, "was made with --graph-only");
  EXPECT_FALSE(std::filesystem::exists(in_folder("all.reeb")));
}

TEST_F(FragmentTest, ReportsTheMemoryOfTheLiveGraphAndOffersNoCommandOnAFragment) {
  make_scan("scan.ply", "2k");
  const Outcome glued = reeb(with({"glue", "-o", "all.reeb", "--report", "all.json"}, fragments("scan.ply", 2)));
  expect_success(glued);
  EXPECT_NE((glued.output + glued.error).find("  surface not checked\n"), std::string::npos)
      << glued.output << glued.error;
  EXPECT_NE(glued.error.find("Reeb graph of 2 fragments for f = z"), std::string::npos) << glued.error;
  const std::string report = file("all.json"), word = "\"bytes\": ";
  const std::size_t at = report.find(word, report.find("\"live_max\""));
  ASSERT_NE(at, std::string::npos);
  EXPECT_GT(std::stoull(report.substr(at + word.size())), 0u) << report;
}

// The header, the counts, the open part, and each block of nodes and arcs: a flipped bit in each of them.
TEST_F(FragmentTest, NamesTheFragmentOfWhichASectionIsDamaged) {
  make_scan("scan.ply", "6k");
  const Words names = fragments("scan.ply", 2);
  const std::string whole = file("p2.fragment");
  std::vector<std::size_t> sections{0, 9, 17, 25, 33, 40};  // of the header; where the state begins
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, whole.data() + at, sizeof value);
    return static_cast<std::size_t>(value);
  };
  const std::size_t state = number(16);
  for (std::size_t part = 1; part <= 4; ++part) sections.push_back(40 + part * state / 4 - 1);
  std::size_t blocks = 0;
  for (std::size_t at = 40 + state; at < whole.size(); at += 32 + number(at + 16), ++blocks)
    sections.insert(sections.end(), {at, at + 8, at + 16, at + 24, at + 32});
  ASSERT_GE(blocks, 2u);
  for (const std::size_t at : sections) {
    SCOPED_TRACE(at);
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    write("p2.fragment", flipped);
    expect_error(reeb({"glue", "p1.fragment", "p2.fragment", "-o", "all.reeb"}), 1, "p2.fragment:");
    EXPECT_FALSE(std::filesystem::exists(in_folder("all.reeb")));
  }
}

// Every length and every byte, in steps.
TEST_F(FragmentTest, RefusesEveryCutAndEveryFlippedBit) {
  write("small.off", kSmallOff);
  fragments("small.off", 2);
  const std::string whole = file("p2.fragment");
  const std::size_t step = whole.size() / 12 + 1;
  for (std::size_t at = 0; at < whole.size(); at += step) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 4);
    write("p2.fragment", flipped);
    expect_error(reeb({"glue", "p1.fragment", "p2.fragment", "-o", "all.reeb"}), 1, "p2.fragment");
    write("p2.fragment", whole.substr(0, at));
    expect_error(reeb({"glue", "p1.fragment", "p2.fragment", "-o", "all.reeb"}), 1, "p2.fragment");
  }
  write("p2.fragment", whole + "x");
  expect_error(reeb({"glue", "p1.fragment", "p2.fragment", "-o", "all.reeb"}), 1, "p2.fragment");
  write("p2.fragment", "hello");
  expect_error(reeb({"glue", "p1.fragment", "p2.fragment", "-o", "all.reeb"}), 1,
               "p2.fragment: this is not a fragment");
  write("small.off", kSmallOff);
  expect_error(reeb({"glue", "p1.fragment", "small.off", "-o", "all.reeb"}), 1,
               "small.off: this is a mesh (OFF), not a fragment");
  expect_success(reeb({"small.off"}));
  expect_error(reeb({"glue", "p1.fragment", "small.reeb", "-o", "all.reeb"}), 1,
               "small.reeb: this is a Reeb graph, not a fragment");
  expect_success(reeb({"fragment", "small.off", "--scan", "--part", "1/1", "-o", "p1.names"}));
  expect_error(reeb({"glue", "p1.fragment", "p1.names", "-o", "all.reeb"}), 1,
               "p1.names: this is a file of names, not a fragment");
}

TEST_F(FragmentTest, RefusesWhatIsNoPartOfAWhole) {
  write("small.off", kSmallOff);
  for (const char* part : {"0/3", "4/3", "1", "1/", "/2", "a/b", "-1/2", "1/2/3"})
    expect_error(reeb({"fragment", "small.off", "--part", part}), 2,
                 std::string{"--part "}.append(part) + ": --part needs K/N");
  expect_error(reeb({"fragment", "-", "--part", "1/2"}), 2, "a part of standard input cannot be computed");
  for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{
           {"--manifold"}, {"--sidecar"}, {"--snapshot-every", "5"}, {"--report", "-"}}) {
    std::vector<std::string> words{"fragment", "small.off", "--part", "1/2"};
    words.insert(words.end(), option.begin(), option.end());
    expect_error(reeb(words), 2, option[0] + ": ");
  }
  fragments("small.off", 1);
  expect_error(reeb({"glue", "p1.fragment", "all.reeb"}), 2, "--output is missing (did you mean -o all.reeb?)");
  expect_error(reeb({"glue", "p1.fragment", "-o", "all.ply"}), 2, "all.ply: the name of the output must end in");
}

}  // namespace
}  // namespace reeb::test
