// Lines of text meshes in all their forms: most are read at once (io/text/plain_line.h), the others word by word. Both
// must give the same mesh, the same errors and the same positions.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/io/formats/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::io::testing {
namespace {

using test::Random;

Mesh random_mesh(Random& random) {
  Mesh mesh;
  const std::uint64_t vertices = random.between(3, 40);
  for (std::uint64_t v = 0; v < vertices; ++v) {
    auto& point = mesh.vertices.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto value = static_cast<float>((random.unit() - 0.5) * (random.chance(20) ? 1e9 : 3));
      point.push_back(random.chance(10) ? 0 : static_cast<double>(value));
    }
  }
  for (std::uint64_t t = random.below(60); t != 0; --t)
    mesh.triangles.push_back({random.below(vertices), random.below(vertices), random.below(vertices)});
  return mesh;
}

// Text with numbers in one of the forms that mean the same; `odd` is a percentage, 0 for the plain form alone.
class Writer {
 public:
  Writer(Random& random, unsigned odd) : random_(random), odd_(odd) {}

  void word(const std::string& text) { out_ << text; }
  void number(double value) {
    blank();
    out_.precision(17);
    if (value == 0 && odd())
      out_ << "-0";
    else
      out_ << (odd() && value >= 0 ? "+" : "") << value;
  }
  void integer(std::uint64_t value, const std::string& suffix = "") {
    blank();
    if (odd()) out_ << "00";
    out_ << value << suffix;
  }
  void end_line() {
    static constexpr const char* kEnds[] = {"\n", " \n", "\r\n", "\t\r\n", "\n\n", "\n \n"};
    out_ << kEnds[odd() ? random_.below(std::size(kEnds)) : 0];
  }
  bool odd() { return random_.chance(odd_); }
  std::string text() const { return out_.str(); }

 private:
  void blank() {
    static constexpr const char* kBlanks[] = {" ", "  ", "\t", " \v", "\f"};
    out_ << kBlanks[odd() ? random_.below(std::size(kBlanks)) : 0];
  }

  Random& random_;
  unsigned odd_;
  std::ostringstream out_;
};

// `surplus` is what may follow a face on its line.
void write_faces(const Mesh& mesh, const std::string& surplus, Writer& out) {
  for (const auto& corners : mesh.triangles) {
    out.integer(3);
    for (const auto corner : corners) out.integer(corner);
    if (out.odd()) out.word(surplus);
    out.end_line();
  }
}

std::string as_ply(const Mesh& mesh, Writer& out) {
  out.word("ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
           "\nproperty uchar red\nproperty float x\nproperty double y\nproperty float z\nelement face " +
           std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const auto& point : mesh.vertices) {
    out.integer(255);
    for (const double value : point) {
      if (out.odd()) out.word("\n");  // a record may run over several lines
      out.number(value);
    }
    if (out.odd()) out.word(" 7 nan");
    out.end_line();
  }
  write_faces(mesh, " 0.5", out);
  return out.text();
}

std::string as_off(const Mesh& mesh, Writer& out) {
  out.word("OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n");
  for (const auto& point : mesh.vertices) {
    for (const double value : point) out.number(value);
    if (out.odd()) out.word(" # a comment");
    out.end_line();
  }
  write_faces(mesh, " 255 0 0", out);
  return out.text();
}

std::string as_obj(const Mesh& mesh, Writer& out) {
  for (const auto& point : mesh.vertices) {
    out.word("v");
    for (const double value : point) {
      if (out.odd()) out.word(" \\\n");
      out.number(value);
    }
    if (out.odd()) out.word(" 1");
    out.end_line();
  }
  for (const auto& corners : mesh.triangles) {
    out.word(out.odd() ? "fo" : "f");
    for (const auto corner : corners) {
      if (out.odd()) out.word(" \\\n");
      out.integer(corner + 1, out.odd() ? "/-1/-2" : out.odd() ? "/3/4" : out.odd() ? "//2" : "");
    }
    if (out.odd()) out.word(" # a comment");
    out.end_line();
  }
  return out.text();
}

TEST(TextLines, MeanTheSameInEachOfTheirForms) {
  using Write = std::string (*)(const Mesh&, Writer&);
  const std::pair<const char*, Write> formats[] = {{"lines.ply", as_ply}, {"lines.off", as_off}, {"lines.obj", as_obj}};
  for (std::uint64_t run = 0; run < test::case_count(300); ++run) {
    Random random(test::base_seed() + run);
    const Mesh mesh = random_mesh(random);
    for (const auto& [name, write] : formats)
      for (const unsigned odd : {0u, 3u, 40u}) {
        Writer out(random, odd);
        const std::string text = write(mesh, out);
        EXPECT_EQ(read_mesh(write_file(name, text)), mesh) << "seed " << test::base_seed() + run << "\n" << text;
      }
  }
}

// A quadrilateral is two triangles, also where a batch has room for one only.
TEST(TextLines, QuadrilateralsOfObjAreSplitAlsoBetweenBatches) {
  const std::vector<std::array<std::uint64_t, 3>> expected = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2},
                                                              {0, 2, 3}, {3, 2, 1}, {3, 1, 0}};
  EXPECT_EQ(read_mesh(write_file("quads.obj",
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                 "f 1 2 3 4\nf 1/7 2/7 3/7 4/7\nf 4 3 2 1\n"))
                .triangles,
            expected);
}

struct Fault {
  const char* text;
  const char* position;
  const char* words;  // of the message
};

void expect_faults(const char* name, const std::string& head, std::initializer_list<Fault> faults) {
  for (const Fault& fault : faults) expect_bad(write_file(name, head + fault.text), fault.position, fault.words);
}

TEST(TextLines, WhatIsWrongInAPlyLineHasItsPosition) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty uchar z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n";  // 11 lines
  expect_faults("fault.ply", head,
                {{"0 1 256\n3 0 1 2\n", "12:5", "does not fit"},
                 {"0 1 1.5\n3 0 1 2\n", "12:5", "cannot be \"1.5\""},
                 {"0 nan 1\n3 0 1 2\n", "12:3", "cannot be"},
                 {"0 1e99 1\n3 0 1 2\n", "12:3", "cannot be"},
                 {"0 1x 1\n3 0 1 2\n", "12:3", "not a number"},
                 {"0 1 1\n3 0 1 3\n", "13:7", "only 3 vertices"},
                 {"0 1 1\n3 0 -1 2\n", "13:5", "names vertex -1"},
                 {"0 1 1\n3 0 1 9999999999999999999\n", "13:7", "cannot be"},
                 {"0 1 1\n3 0 1 3000000000\n", "13:7", "does not fit"},
                 {"0 1 1\n300 0 1 2\n", "13:1", "does not fit"}});
}

TEST(TextLines, WhatIsWrongInAnObjLineHasItsPosition) {
  expect_faults("fault.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
                {{"v 0 inf 0\n", "4:5", "cannot be"},
                 {"v 0 0\n", "4:6", "line ends"},
                 {"f 1 2 4\n", "4:7", "only 3 vertices"},
                 {"f 1 2 0\n", "4:7", "vertex 0"},
                 {"f 1 2 3x\n", "4:7", "of the form"},
                 {"f 1 2 3.5\n", "4:7", "of the form"},
                 {"f 1 2 1234567890123456789\n", "4:7", "too large"}});
}

// However the line is read: a comment keeps it from being read at once.
TEST(TextLines, ANumberThatIsTooLongIsRefused) {
  const std::string longest = "0." + std::string(4093, '1'), longer = longest + std::string(1000, '1');
  for (const std::string ending : {"", " # a comment"}) {
    SCOPED_TRACE(ending);
    const auto obj = [&](const std::string& y) { return "v 0 " + y + " 0" + ending + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"; };
    const auto off = [&](const std::string& y) {
      return "OFF\n3 1 0\n0 " + y + " 0" + ending + "\n1 0 0\n0 1 0\n3 0 1 2\n";
    };
    EXPECT_NEAR(read_mesh(write_file("long.obj", obj(longest))).vertices.at(0).at(1), 1.0 / 9, 1e-7);
    EXPECT_NEAR(read_mesh(write_file("long.off", off(longest))).vertices.at(0).at(1), 1.0 / 9, 1e-7);
    for (const std::string& y : {longest + "1", longer}) {
      expect_bad(write_file("longer.obj", obj(y)), "1:5", "more than 4096 characters");
      expect_bad(write_file("longer.off", off(y)), "3:3", "more than 4096 characters");
    }
  }
}

}  // namespace
}  // namespace reeb::io::testing
