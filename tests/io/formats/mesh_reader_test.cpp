// The readers against files written by hand, and against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "tests/io/formats/mesh_files.h"
#include "tests/support/data.h"
#include "tests/support/files.h"

namespace reeb::io::testing {
namespace {

// A tetrahedron with float32 coordinates; vertices in the order in which corners name them.
const Mesh kTetrahedron = {{{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, -1}},
                           {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

std::string ply_header(const std::string& encoding, const std::string& eol = "\n") {
  std::string text;
  for (const std::string& line :
       {std::string("ply"), "format " + encoding + " 1.0", std::string("comment by hand"),
        std::string("element vertex 4"), std::string("property float x"), std::string("property float32 y"),
        std::string("property float z"), std::string("element face 4"),
        std::string("property list uchar int vertex_indices"), std::string("end_header")})
    text += line + eol;
  return text;
}

std::string ascii_ply(const std::string& eol = "\n") {
  std::ostringstream text;
  text << ply_header("ascii", eol);
  for (const auto& v : kTetrahedron.vertices) text << v[0] << " " << v[1] << "\t" << v[2] << " " << eol;
  for (const auto& t : kTetrahedron.triangles) text << "3 " << t[0] << " " << t[1] << " " << t[2] << eol;
  return text.str();
}

std::string binary_ply(bool big) {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian");
  for (const auto& v : kTetrahedron.vertices)
    for (const double x : v) bytes += scalar_bytes(static_cast<float>(x), big);
  for (const auto& t : kTetrahedron.triangles) {
    bytes += '\3';
    for (const auto corner : t) bytes += scalar_bytes(static_cast<std::int32_t>(corner), big);
  }
  return bytes;
}

std::string obj() {
  std::ostringstream text;
  for (const auto& v : kTetrahedron.vertices) text << "v " << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : kTetrahedron.triangles) text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return text.str();
}

std::string off(const std::string& head = "OFF\n4 4 6\n") {
  std::ostringstream text;
  text << head;
  for (const auto& v : kTetrahedron.vertices) text << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : kTetrahedron.triangles) text << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return text.str();
}

// Each vertex has so many further numbers, which are not read.
std::string binary_off(const std::string& keyword = "OFF", int further = 0) {
  std::string bytes = keyword + " BINARY\n";
  for (const std::int32_t count : {4, 4, 6}) bytes += scalar_bytes(count, true);
  for (const auto& v : kTetrahedron.vertices) {
    for (const double x : v) bytes += scalar_bytes(static_cast<float>(x), true);
    for (int i = 0; i < further; ++i) bytes += scalar_bytes(0.25F, true);
  }
  for (const auto& t : kTetrahedron.triangles) {
    bytes += scalar_bytes(std::int32_t{3}, true);
    for (const auto corner : t) bytes += scalar_bytes(static_cast<std::int32_t>(corner), true);
    bytes += scalar_bytes(std::int32_t{1}, true) + scalar_bytes(0.5F, true);  // a colour
  }
  return bytes;
}

std::string ascii_stl() {
  std::ostringstream text;
  text << "solid one\n";
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == 2) text << "endsolid one\nsolid two\n";
    text << "facet normal 0 0 nan\n outer loop\n";
    for (const auto corner : kTetrahedron.triangles[i]) {
      text << "  vertex";
      for (const double x : kTetrahedron.vertices[corner]) text << " " << (x == 0 ? "-0" : std::to_string(x));
      text << "\n";
    }
    text << " endloop\nendfacet\n";
  }
  text << "endsolid two\n";
  return text.str();
}

std::string binary_stl(std::uint32_t promised = 4) {
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  bytes += scalar_bytes(promised);
  for (const auto& t : kTetrahedron.triangles) {
    for (int k = 0; k < 3; ++k) bytes += scalar_bytes(0.0F);
    for (const auto corner : t)
      for (const double x : kTetrahedron.vertices[corner]) bytes += scalar_bytes(static_cast<float>(x));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string run_on(const char* command, const std::string& path, const std::string& ending) {
  const std::string packed = path + ending;
  EXPECT_EQ(std::system((std::string(command) + " < '" + path + "' > '" + packed + "'").c_str()), 0);
  return packed;
}

struct Example {
  std::string name, bytes;
};
std::vector<Example> examples() {
  return {{"a.ply", ascii_ply()},
          {"crlf.ply", ascii_ply("\r\n")},
          {"le.ply", binary_ply(false)},
          {"be.ply", binary_ply(true)},
          {"a.obj", obj()},
          {"a.off", off()},
          {"b.off", binary_off()},
          {"a.stl", ascii_stl()},
          {"b.stl", binary_stl()}};
}

TEST(Readers, AllFormatsGiveTheSameMesh) {
  for (const auto& [name, bytes] : examples()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(read_mesh(write_file(name, bytes)), kTetrahedron);
  }
}

TEST(Readers, EveryPrefixIsAnErrorOrAPart) {
  for (const auto& [name, bytes] : examples()) {
    SCOPED_TRACE(name);
    expect_prefixes_safe(name, bytes);
  }
}

TEST(Readers, PackedFilesOfSeveralPartsAndUnderAnyName) {
  for (const auto& [name, bytes] : examples()) {
    SCOPED_TRACE(name);
    const std::string first = write_file("first", bytes.substr(0, 40)), rest = write_file("rest", bytes.substr(40));
    for (const char* tool : {"gzip", "zstd -q"}) {
      std::string packed;
      for (const auto& part : {run_on(tool, first, ".1"), run_on(tool, rest, ".2")}) packed += test::read_file(part);
      EXPECT_EQ(read_mesh(write_file("packed", packed)), kTetrahedron) << tool;
      EXPECT_EQ(open_mesh(write_file("packed", packed))->indexed(), nullptr);
      for (std::size_t cut = 1; cut < 30; ++cut) {
        const std::string path = write_file("cut", packed.substr(0, packed.size() - cut));
        EXPECT_THROW(read_all(*open_mesh(path)), Error) << tool << " cut by " << cut;
      }
    }
  }
}

// OBJ and streaming meshes may be empty files.
TEST(Readers, PackedFilesThatAreCutAmongTheirFirstBytesAreNotEmpty) {
  const std::string plain = write_file("plain", "v 0 0 0\n");
  for (const std::string name : {"cut.obj", "cut.sma"})
    for (const auto& [tool, suffix] : {std::pair("gzip", ".gz"), std::pair("zstd -q", ".zst")}) {
      const std::string packed = test::read_file(run_on(tool, plain, suffix));
      for (std::size_t size = 0; size < 6; ++size) {
        const std::string path = write_file(name + suffix, packed.substr(0, size));
        EXPECT_THROW(read_all(*open_mesh(path)), Error) << path << ", " << size << " bytes";
      }
    }
}

// Tapes fill their blocks with zeros.
TEST(Readers, ZerosAfterTheLastMemberOfGzipAreIgnored) {
  const std::string packed = test::read_file(run_on("gzip", write_file("plain", ascii_ply()), ".gz"));
  for (const std::size_t zeros : {1u, 512u, 200'000u})
    EXPECT_EQ(read_mesh(write_file("padded.gz", packed + std::string(zeros, '\0'))), kTetrahedron) << zeros;
  for (const std::string& rest : {std::string("x"), std::string("\0\0x", 3), '\0' + packed})
    expect_bad(write_file("rest.gz", packed + rest), std::nullopt, "bytes after the last member");
}

// Scans have NaN in normals and confidences. `q` and `r` of three vertices.
std::string ply_with_non_finite_values(const std::string& encoding) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
  const std::array<std::array<double, 4>, 3> rows = {{{0, 0, kNan, 1}, {1, 0, 7, -kInfinity}, {0, 1, 8, kInfinity}}};
  const bool ascii = encoding == "ascii", big = encoding == "binary_big_endian";
  std::ostringstream text;
  text << "ply\nformat " << encoding
       << " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float q\nproperty double r\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& row : rows) {
    if (ascii)
      text << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3] << '\n';
    else
      for (std::size_t k = 0; k < 4; ++k)
        text << (k < 3 ? scalar_bytes(static_cast<float>(row[k]), big) : scalar_bytes(row[k], big));
  }
  if (ascii) return text.str() + "3 0 1 2\n";
  text << '\3';
  for (const std::int32_t corner : {0, 1, 2}) text << scalar_bytes(corner, big);
  return text.str();
}

TEST(Readers, PropertiesThatAreOnlyCarriedAlongNeedNotBeFinite) {
  for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    SCOPED_TRACE(encoding);
    const std::string path = write_file("odd.ply", ply_with_non_finite_values(encoding));
    ReadOptions all;
    all.all_properties = true;
    const auto reader = open_mesh(path, all);
    const Mesh mesh = read_all(*reader);
    ASSERT_EQ(mesh.vertices.size(), 3u);
    EXPECT_TRUE(std::isnan(mesh.vertices[0][2]));
    EXPECT_EQ(mesh.vertices[1], (std::vector<double>{1, 0, 7, -std::numeric_limits<double>::infinity()}));
    EXPECT_EQ(mesh.vertices[2], (std::vector<double>{0, 1, 8, std::numeric_limits<double>::infinity()}));
    EXPECT_EQ(reader->warnings(), std::vector<std::string>{"3 values of properties that are not used are not finite"});
    if (encoding != "ascii") {
      const auto indexed = open_mesh(path, all)->indexed();
      const Mesh looked_up = read_indexed(*indexed);
      EXPECT_EQ(indexed->warnings(), reader->warnings());
      EXPECT_TRUE(std::isnan(looked_up.vertices[0][2]));
      EXPECT_EQ(looked_up.vertices[2], mesh.vertices[2]);
    }
    // What is asked for must be finite, also if all others are delivered.
    for (const bool others : {false, true}) {
      ReadOptions named;
      named.properties = {"q"};
      named.all_properties = others;
      EXPECT_THROW(read_all(*open_mesh(path, named)), Error);
      if (encoding != "ascii") {
        EXPECT_THROW(read_indexed(*open_mesh(path, named)->indexed()), Error);
      }
    }
  }
}

// Random access reads only the columns that are used.
TEST(Readers, NonFiniteValuesOfUnusedPropertiesAreCounted) {
  using Lines = std::vector<std::string>;
  for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    SCOPED_TRACE(encoding);
    std::string bytes = ply_with_non_finite_values(encoding);
    const std::string path = write_file("unused.ply", bytes);
    const auto reader = open_mesh(path);
    read_all(*reader);
    const Lines note = {"3 values of properties that are not used are not finite"};
    EXPECT_EQ(reader->warnings(), note);
    if (encoding == "ascii") continue;
    const auto indexed = open_mesh(path)->indexed();
    EXPECT_EQ(indexed->warnings(), note);
    read_indexed(*indexed);
    EXPECT_EQ(indexed->warnings(), note);
    const bool big = encoding == "binary_big_endian";
    bytes.replace(bytes.find("float q"), 7, "int32 q");
    bytes.replace(bytes.find("double r"), 8, "double z");
    EXPECT_EQ(open_mesh(write_file("used.ply", bytes))->indexed()->warnings(), Lines());
    const std::string head = "ply\nformat " + encoding + " 1.0\nelement vertex 1\nproperty float x\nproperty float q\n";
    const std::string vertex = scalar_bytes(1.0F, big) + scalar_bytes(2.0F, big);
    EXPECT_EQ(open_mesh(write_file("finite.ply", head + "end_header\n" + vertex))->indexed()->warnings(), Lines());
  }
}

TEST(Readers, SmallOddities) {
  EXPECT_EQ(read_mesh(write_file("bom.obj", "\xEF\xBB\xBF" + obj())), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("eof.obj", obj().substr(0, obj().size() - 1))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("eof.ply", ascii_ply().substr(0, ascii_ply().size() - 1))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("one_line.off", off("# a\nOFF 4 4 0 # b\n\n"))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("n.off", off("nOFF 3\n4 4 0\n"))), kTetrahedron);
  // Each count on a line of its own; the number of edges may be missing.
  EXPECT_EQ(read_mesh(write_file("counts.off", off("OFF\n4\n4\n6\n"))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("counts.off", off("OFF\n4 # vertices\n\n4\n# edges\n6\n"))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("counts.off", off("OFF\n4\n4\n"))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("counts.off", off("OFF\n4 4\n"))), kTetrahedron);
}

// Files that others read, although they are not as they should be.
TEST(Readers, RecordsOverSeveralLines) {
  const auto broken = [](std::string text, std::size_t from) {
    for (std::size_t i = from; i < text.size(); ++i)
      if (text[i] == ' ' && i % 3 == 0) text[i] = '\n';
    return text;
  };
  const std::string header = ply_header("ascii");
  EXPECT_EQ(read_mesh(write_file("lines.ply", broken(ascii_ply(), header.size()))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("lines.off", broken(off(), 8))), kTetrahedron);
  const std::string strip =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n0 \n\n1\n2\n3\n6\n0 1 2\n3 -1\n0\n";
  EXPECT_THROW(read_mesh(write_file("cut.ply", strip.substr(0, strip.size() - 2))), Error);
}

TEST(Readers, SurplusValuesAtTheEndOfALineAreCounted) {
  std::string text = ascii_ply();
  for (const char* const line : {"3 1 2 3", "3 2 0 3"}) text.insert(text.find(line) + 7, " 9 nan 1e");
  const std::string path = write_file("surplus.ply", text);
  EXPECT_EQ(read_mesh(path), kTetrahedron);
  const auto reader = open_mesh(path);
  read_all(*reader);
  EXPECT_EQ(reader->warnings(),
            std::vector<std::string>{"6 values at the end of lines were ignored: the header does not declare them"});
}

TEST(Readers, EdgesOfPlyAreNoted) {
  std::string text = ascii_ply();
  text.insert(text.find("end_header"), "element edge 2\nproperty int vertex1\nproperty int vertex2\n");
  const std::string path = write_file("edges.ply", text + "0 1\n1 2\n");
  EXPECT_EQ(read_mesh(path), kTetrahedron);
  const auto reader = open_mesh(path);
  read_all(*reader);
  EXPECT_EQ(reader->warnings(),
            std::vector<std::string>{"2 edges were ignored: of PLY, vertices, faces and strips are read"});
}

// These formats do not say how much is to come, so a cut file can look whole.
TEST(Readers, AnItemOnALastLineWithoutAnEndIsNoted) {
  const std::vector<std::string> note = {"the last line has no line end; the file may be cut there"};
  const auto notes = [](const std::string& name, const std::string& text) {
    const auto reader = open_mesh(write_file(name, text));
    read_all(*reader);
    return reader->warnings();
  };
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4",
                    cx = "v 0 0\nv 1 0\nv 0 1\ns 0 1 2\ns 0 1";
  EXPECT_EQ(notes("a.obj", obj), note);
  EXPECT_EQ(notes("a.cx", cx), note);
  EXPECT_EQ(notes("a.obj", "v 0 0 0\nv 1 0 0"), note);
  EXPECT_EQ(notes("a.cx", "v 0 0"), note);
  for (const std::string end : {"\n", "\n\n", "\r\n", "\n# the end", "\n "}) {
    EXPECT_EQ(notes("a.obj", obj + end), std::vector<std::string>()) << end;
    EXPECT_EQ(notes("a.cx", cx + end), std::vector<std::string>()) << end;
  }
}

TEST(Ply, AHeaderLineThatLacksTheWordComment) {
  for (std::string text : {ascii_ply(), binary_ply(false)}) {
    text.insert(text.find("element vertex"), "Created by a scanner, 7 int\nproduced with care\n");
    const std::string path = write_file("created.ply", text);
    EXPECT_EQ(read_mesh(path), kTetrahedron);
    const auto reader = open_mesh(path);
    read_all(*reader);
    EXPECT_EQ(reader->warnings(), std::vector<std::string>{"2 lines of the header are not PLY and were ignored"});
  }
  for (const auto& [from, to] : {std::pair{"format", "fromat"},
                                 {"element vertex", "elment vertex"},
                                 {"property list", "proprty list"},
                                 {"property float z", "prop float z"}}) {
    std::string text = ascii_ply();
    text.replace(text.find(from), std::strlen(from), to);
    EXPECT_THROW(open_mesh(write_file("damaged.ply", text)), Error) << to;
  }
}

TEST(Off, BlanksBeforeTheKeyword) {
  EXPECT_EQ(read_mesh(write_file("blank.off", off(" \n\t OFF\n4 4 6\n"))), kTetrahedron);
  EXPECT_EQ(read_mesh(write_file("counts.off", off("  OFF  4 4 6 # counts\n"))), kTetrahedron);
}

TEST(Obj, OfCommentsOnlyIsToldByItsName) {
  const std::string text = "# an empty scene\n\n# o nothing\n";
  EXPECT_EQ(read_mesh(write_file("comments.obj", text)), Mesh());
  expect_bad(write_file("comments.txt", text), "0", "unknown file format");
  expect_bad(write_file("words.obj", "an empty scene\n"), "0", "unknown file format");
}

TEST(Ply, TypesOrderExtrasAndStrips) {
  const std::string bytes =
      "ply\nformat ascii 1.0\nelement edge 1\nproperty int a\nproperty list uint8 double b\n"
      "element vertex 5\nproperty uchar red\nproperty double z\nproperty list char short l\n"
      "property float quality\nproperty float x\nproperty int16 y\n"
      "element face 5\nproperty float area\nproperty list ushort uint16 vertex_index\nproperty int flags\n"
      "element tristrips 1\nproperty list int int32 vertex_indices\nelement other 1\nproperty int q\nend_header\n"
      "1 2 0.5 nan\n"
      "7 0.1 0 0.1 0.1 3\n8 -0.0 1 5 nan 1 4\n9 3 2 1 1 +1.5 2 5\n1 4 0 inf 2 6\n2 5 0 1 3 7\n"
      "1.5 4 0 1 2 3 9\n0 2 4 1 9\n0 1 3 9\n0 0 9\n0 3 0 0 1 9\n"
      "8 0 1 2 3 -1 4 3 2\n"
      "5\n";
  const std::string path = write_file("rich.ply", bytes);
  const Mesh mesh = read_mesh(path, {"red"});
  const double tenth = static_cast<double>(0.1F);
  EXPECT_EQ(mesh.vertices, (std::vector<std::vector<double>>{
                               {tenth, 3, 0.1, 7}, {1, 4, 0, 8}, {2, 5, 3, 9}, {2, 6, 4, 1}, {3, 7, 5, 2}}));
  // A fan, an edge, a vertex, nothing, a degenerate triangle; then two strips.
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{
                                {0, 1, 2}, {0, 2, 3}, {0, 0, 1}, {0, 1, 2}, {2, 1, 3}, {4, 3, 2}}));
  EXPECT_EQ(mesh.edges, (std::vector<std::vector<std::uint64_t>>{{4, 1}}));
  EXPECT_EQ(mesh.points, (std::vector<std::vector<std::uint64_t>>{{3}}));
  const auto reader = open_mesh(path);
  EXPECT_EQ(reader->info().property_names, (std::vector<std::string>{"red", "quality"}));
  read_all(*reader);
  EXPECT_EQ(reader->warnings().size(), 2u) << "the quality that is not finite, of vertices 1 and 3; and edges";
}

TEST(Off, BinaryVerticesHaveNormalsColoursAndTexture) {
  for (const auto& [keyword, further] : {std::pair("NOFF", 3), std::pair("COFF", 4), std::pair("STOFF", 2),
                                         std::pair("CNOFF", 7), std::pair("STCNOFF", 9)}) {
    const Mesh mesh = read_mesh(write_file("further.off", binary_off(keyword, further)));
    EXPECT_EQ(mesh, kTetrahedron) << keyword;
  }
}

TEST(Ply, NumbersOfATextFitTheirDeclaredType) {
  std::string head = "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nelement face 1\n", vertices;
  for (int i = 0; i < 300; ++i) vertices += "0\n";
  for (const std::string more : {"", "property uchar colour\n"}) {
    const std::string begin = head + "property list uchar uchar vertex_indices\n" + more + "end_header\n" + vertices;
    const std::string end = more.empty() ? "\n" : " 7\n";
    EXPECT_EQ(read_mesh(write_file("fits.ply", begin + "3 0 1 255" + end)).triangles.size(), 1u);
    expect_bad(write_file("large.ply", begin + "3 0 1 256" + end), {}, "256 does not fit its declared type");
  }
}

TEST(Ply, FacesBeforeVertices) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uchar uint vertex_indices\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  std::string bytes = head + '\3';
  for (const std::uint32_t corner : {2u, 1u, 0u}) bytes += scalar_bytes(corner);
  for (int i = 0; i < 9; ++i) bytes += scalar_bytes(static_cast<float>(i));
  const std::string path = write_file("faces_first.ply", bytes);
  const Mesh expected = {{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}, {{2, 1, 0}}};
  EXPECT_EQ(read_mesh(path), expected);
  const std::string packed = run_on("gzip", path, ".gz");
  expect_bad(packed, "", "read only once");
}

TEST(Ply, IndexedIsTheSameMesh) {
  for (const bool big : {false, true}) {
    const auto indexed = open_mesh(write_file("indexed.ply", binary_ply(big)))->indexed();
    ASSERT_NE(indexed, nullptr);
    EXPECT_EQ(read_indexed(*indexed), kTetrahedron);
    indexed->rewind();
    EXPECT_EQ(read_indexed(*indexed), kTetrahedron);
  }
  EXPECT_EQ(open_mesh(write_file("a.ply", ascii_ply()))->indexed(), nullptr);
  EXPECT_EQ(open_mesh(write_file("a.obj", obj()))->indexed(), nullptr);
}

// Once a mesh is open, neither its name nor its header is used again: not for random access to its vertices, and not to
// return to the first face.
TEST(Ply, IsOpenedOnceAndItsHeaderIsReadOnce) {
  const std::string bytes = binary_ply(false), path = write_file("once.ply", bytes);
  const auto reader = open_mesh(path);
  const std::size_t header_bytes = bytes.find("end_header");
  std::fstream(path, std::ios::in | std::ios::out | std::ios::binary) << std::string(header_bytes, '?');
  ASSERT_EQ(test::read_file(path).size(), bytes.size());
  std::filesystem::remove(path);
  const auto indexed = reader->indexed();
  ASSERT_NE(indexed, nullptr);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(read_indexed(*indexed), kTetrahedron);
    indexed->rewind();
    EXPECT_LT(indexed->bytes_read(), bytes.size());
  }
  EXPECT_EQ(read_all(*reader), kTetrahedron);
  EXPECT_EQ(read_indexed(*reader->indexed()), kTetrahedron);
}

// Returns to the first face in the middle of a polygon, past elements without faces, with faces that are not plain.
TEST(Ply, IndexedGoesBackFromAnywhere) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement extra 2\nproperty short s\nelement vertex 5\nproperty float x\n"
      "element face 2\nproperty uchar colour\nproperty list uchar int vertex_indices\nend_header\n";
  bytes += scalar_bytes(std::int16_t{1}) + scalar_bytes(std::int16_t{2});
  for (int i = 0; i < 5; ++i) bytes += scalar_bytes(static_cast<float>(i));
  for (int face = 0; face < 2; ++face) {
    bytes += std::string("\7\5", 2);
    for (std::int32_t corner = 0; corner < 5; ++corner) bytes += scalar_bytes(corner);
  }
  const std::string path = write_file("back.ply", bytes);
  const Mesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.triangles.size(), 6u);
  const auto indexed = open_mesh(path)->indexed();
  ASSERT_NE(indexed, nullptr);
  std::vector<VertexId> corners;
  for (std::size_t limit = 1; limit < 6; ++limit) {
    indexed->read(corners, limit);
    indexed->rewind();
    EXPECT_EQ(read_indexed(*indexed), mesh) << limit;
    indexed->rewind();
  }
}

// As many as are read, with x.
TEST(Ply, AHeaderMayHaveManyProperties) {
  constexpr std::size_t kCount = 9998;
  std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar x\n", body = "3";
  ReadOptions options;
  for (std::size_t i = 0; i < kCount; ++i) {
    options.properties.push_back(std::string("p").append(std::to_string(i)));
    head += "property uchar " + options.properties.back() + "\n";
    body += i % 2 == 0 ? " 0" : " 1";
  }
  const Mesh mesh = read_all(*open_mesh(write_file("many.ply", head + "end_header\n" + body + "\n"), options));
  ASSERT_EQ(mesh.vertices.size(), 1u);
  ASSERT_EQ(mesh.vertices[0].size(), kCount + 1);
  EXPECT_EQ(mesh.vertices[0].back(), 1);
  expect_bad(write_file("twice.ply", head + "property uchar p7\nend_header\n" + body + " 0\n"),
             std::to_string(kCount + 5) + ":16", "the property \"p7\" is declared twice");
  head += "property uchar last\n";
  EXPECT_EQ(open_mesh(write_file("most.ply", head + "end_header\n" + body + " 0\n"))->info().property_names.size(),
            kCount + 1);
  expect_bad(write_file("more.ply", head + "property uchar more\nend_header\n" + body + " 0 0\n"),
             std::to_string(kCount + 6) + ":16", "more than 10,000 properties");
}

// A packed file of some kilobytes can list millions.
TEST(Ply, AHeaderHasALimit) {
  const std::string begin = "ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar x\n", end = "end_header\n3\n";
  std::string elements, names;
  for (int i = 1; i < 10000; ++i) elements += "element e 0\n";
  EXPECT_EQ(read_mesh(write_file("elements.ply", begin + elements + end)).vertices.size(), 1u);
  expect_bad(write_file("elements.ply", begin + elements + "element e 0\n" + end), std::nullopt,
             "more than 10,000 elements");
  for (int i = 0; i < 300; ++i) names += "property uchar " + std::to_string(i) + std::string(4000, 'n') + "\n";
  expect_bad(write_file("names.ply", begin + names + end), std::nullopt,
             "properties of the file have more than 1,000,000 characters in all");
}

// The same name in two elements is two properties.
TEST(Ply, NamesAreOfAnElement) {
  const Mesh mesh = {{{5, 6}}, {}};
  const std::string path = write_file("names.ply",
                                      "ply\nformat ascii 1.0\nelement other 1\nproperty int q\nelement vertex 1\n"
                                      "property int x\nproperty int q\nend_header\n9\n5 6\n");
  EXPECT_EQ(read_mesh(path, {"q"}), mesh);
}

TEST(Obj, FacesOfAllForms) {
  const Mesh mesh = read_mesh(
      write_file("forms.obj",
                 "# dir C:\\tmp\\\nmtllib a\ng\no x\nv 0 0 0\nv 1 0 0 1.0\nvt 0 0\nv 0 1 0 0.5 0.5 nan\nvn 0 0 1\n"
                 "f 1/1 2/1 3/1 # c\nv 4 4 -0.0\ns 1\nusemtl b\nf -1//1 -2//1 1//1\nf 1/1/1 2/1/1 \\\n 3/1/1 4/1/1\r\n"
                 "l 1 2 3\nl 4\np 1 2\nf 2\nf 3 4\nodd line"));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 1, 2}, {3, 2, 0}, {0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.edges, (std::vector<std::vector<std::uint64_t>>{{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(mesh.points, (std::vector<std::vector<std::uint64_t>>{{3}, {0}, {1}, {1}}));
  const auto reader = open_mesh(write_file("odd.obj", "v 0 0 0\nodd line\nv 1 1 1\n"));
  read_all(*reader);
  EXPECT_EQ(reader->warnings().size(), 1u);
}

TEST(Off, PrefixesAndDimensions) {
  const Mesh colours = read_mesh(write_file("c.off", "COFF\n1 1 0\n1 2 3 255 0 0 255\n1 0 0.5 0.5 0.5\n"));
  EXPECT_EQ(colours, (Mesh{{{1, 2, 3}}, {}, {}, {{0}}}));
  EXPECT_EQ(read_mesh(write_file("stcn4.off", "STCN4OFF 1 0 0\n1 2 3 4 0 0 1 1\n")), (Mesh{{{1, 2, 3, 4}}, {}}));
  EXPECT_EQ(read_mesh(write_file("n5.off", "nOFF\n5\n1 0 0\n1 2 3 4 5\n")), (Mesh{{{1, 2, 3, 4, 5}}, {}}));
  EXPECT_EQ(open_mesh((scratch_folder() / "n5.off").string())->info().dimension, 5u);
}

TEST(Errors, HavePositionAndHint) {
  const std::string ply = ascii_ply();
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos);
    return text.replace(place, from.size(), to);
  };
  expect_bad((scratch_folder() / "absent").string(), "", "no such file");
  expect_bad(scratch_folder().string(), "", "a folder");
  expect_bad(write_file("empty", ""), "0", "empty");
  expect_bad(write_file("unknown", "hello world\n"), "0", "unknown file format");
  expect_bad(write_file("p1.ply", with(ply, "1 0\t0", "1 nan\t0")), "12:3", "cannot be \"nan\"");
  expect_bad(write_file("p2.ply", with(ply, "1 0\t0", "1 1e39\t0")), "12:3", "1e39");
  expect_bad(write_file("p3.ply", with(ply, "3 2 0 3", "3 2 0 4")), "18:7", "names vertex 4");
  expect_bad(write_file("p4.ply", with(ply, "3 2 0 3", "3 2 0")), "19:1", "the file ends where a vertex index");
  expect_bad(write_file("p5.ply", with(ply, "element face", "elment face")), "8:1", "not a PLY header line");
  expect_bad(write_file("p8.ply", with(ply, "1 0\t0", "1 0")), "19:1", "ends inside");
  expect_bad(write_file("p6.ply", with(ply, "face 4", "face 5")), "19:1", "ends inside");
  expect_bad(write_file("p7.ply", with(ply, "face 4", "face 9000000000000")), "10:1", "announces 9,000,000,000,000");
  const std::string binary = binary_ply(false);
  const std::size_t body = ply_header("binary_little_endian").size();
  expect_bad(write_file("b1.ply", binary.substr(0, binary.size() - 1)), std::to_string(binary.size() - 1),
             "ends before");
  std::string wide = "ply\nformat binary_little_endian 1.0\nelement wide 1\n";
  for (int k = 0; k < 8193; ++k) wide += "property double p" + std::to_string(k) + "\n";
  wide += binary.substr(binary.find("element vertex"))
              .insert(binary.find("end_header") + 11 - binary.find("element vertex"), std::string(8193 * 8, '\0'));
  expect_bad(write_file("b4.ply", wide), std::nullopt, "a record of the element wide has more than 65,536 bytes");
  std::string odd = binary;
  odd.replace(body + 16, 4, scalar_bytes(std::numeric_limits<float>::quiet_NaN()));
  expect_bad(write_file("b2.ply", odd), std::to_string(body + 16), "of vertex 1 is not finite");
  odd = binary;
  odd.replace(odd.size() - 4, 4, scalar_bytes(std::int32_t{-1}));
  expect_bad(write_file("b3.ply", odd), std::to_string(odd.size() - 4), "names vertex -1");
  expect_bad(write_file("o1.obj", "v 0 0 0\nf 1 1 2\nv 1 1 1\n"), "2:7", "names vertex 2");
  expect_bad(write_file("o2.obj", "v 0 0 0\nf 0 1 1\n"), "2:3", "vertex 0");
  expect_bad(write_file("o3.obj", "v 0 0 0\nf 1 \\\n 1 -2\n"), "3:4", "names vertex -2");
  expect_bad(write_file("o4.obj", "v 0 0\n"), "1:6", "line ends");
  expect_bad(write_file("o5.obj", "v 0 0 0 0 0\n"), "1:11", "5 numbers");
  for (const std::string word : {"f", "l", "p"}) {
    expect_bad(write_file("o7.obj", "v 0 0 0\n" + word + "\nf 1 1 1\n"), "2:1", "without a vertex");
    expect_bad(write_file("o8.obj", "v 0 0 0\n" + word + "  # 1 1 1"), "2:1", "without a vertex");
  }
  expect_bad(write_file("o6.obj", "v 0 0 -inf\n"), "1:7", "-inf");
  expect_bad(write_file("f1.off", "OFF\n9999999 1 0\n0 0 0\n"), "2:9", "announces");
  expect_bad(write_file("f2.off", off("OFF 4 5 0\n")), "10:1", "ends where a number of corners");
  expect_bad(write_file("s1.stl", binary_stl(5)), "80", "announces 5 facets");
  expect_bad(write_file("s2.stl", "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 inf\n"), "4:12", "inf");
  for (const std::string end : {"endloop\nendfacet", "endfacet"}) {
    const std::string facet = "solid\nfacet normal 0 0 0\nouter loop\n";
    const std::string rest = end + "\nendsolid\n", corner = "vertex 0 0 1\n";
    expect_bad(write_file("s3.stl", facet + "vertex 0 0 0\n" + corner + rest), "6:1", "a facet of 2 corners");
    expect_bad(write_file("s4.stl", facet + rest), "4:1", "a facet of 0 corners");
  }
  expect_bad(write_file("q.ply", binary), "", "no vertex property \"q\"", {{"q"}, 65536});
}

// Larger than several windows, so that records, lines and tokens cross the borders of windows.
TEST(Readers, ManyWindowsInTextAndBinary) {
  constexpr std::uint32_t kCount = 150'000;
  std::string text, binary = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(kCount) +
                             "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar c\nelement face " +
                             std::to_string(kCount - 2) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  std::string faces;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const float x = static_cast<float>(i) * 0.25F;
    text += "v " + std::to_string(x) + " " + std::to_string(-x) + " 1\n";
    binary += scalar_bytes(x) + scalar_bytes(-x) + scalar_bytes(1.0F) + "c";
    if (i < 2) continue;
    text += "f " + std::to_string(i - 1) + " " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
    faces += '\3' + scalar_bytes(i - 2) + scalar_bytes(i - 1) + scalar_bytes(i);
  }
  ASSERT_GT(text.size(), std::size_t{4} << 20);
  const std::string path = write_file("large.obj", text), ply = write_file("large.ply", binary + faces);
  const Mesh mesh = read_all(*open_mesh(path));
  ASSERT_EQ(mesh.vertices.size(), kCount);
  EXPECT_EQ(mesh.vertices[kCount - 1], (std::vector<double>{0.25 * (kCount - 1), -0.25 * (kCount - 1), 1}));
  EXPECT_EQ(mesh.triangles[kCount - 3], (std::array<std::uint64_t, 3>{kCount - 3, kCount - 2, kCount - 1}));
  EXPECT_TRUE(read_all(*open_mesh(ply)) == mesh);
  EXPECT_TRUE(read_indexed(*open_mesh(ply)->indexed()) == mesh);
  EXPECT_TRUE(read_all(*open_mesh(run_on("gzip", path, ".gz"))) == mesh);
  EXPECT_TRUE(read_all(*open_mesh(run_on("zstd -q", path, ".zst"))) == mesh);
}

TEST(Readers, StandardInput) {
  for (const auto& [name, bytes] : examples()) {
    SCOPED_TRACE(name);
    ASSERT_NE(std::freopen(write_file(name, bytes).c_str(), "rb", stdin), nullptr);
    EXPECT_EQ(read_all(*open_mesh("-")), kTetrahedron);
  }
  ASSERT_NE(std::freopen(write_file("nothing", "").c_str(), "rb", stdin), nullptr);
  EXPECT_THROW(open_mesh("-"), Error);
}

TEST(Ply, EveryScalarTypeInBothSpellings) {
  struct Type {
    std::string names[2], little, big;
  };
  const std::vector<Type> types = {
      {{"char", "int8"}, scalar_bytes(std::int8_t{-2}), scalar_bytes(std::int8_t{-2}, true)},
      {{"uchar", "uint8"}, scalar_bytes(std::uint8_t{254}), scalar_bytes(std::uint8_t{254}, true)},
      {{"short", "int16"}, scalar_bytes(std::int16_t{-300}), scalar_bytes(std::int16_t{-300}, true)},
      {{"ushort", "uint16"}, scalar_bytes(std::uint16_t{65000}), scalar_bytes(std::uint16_t{65000}, true)},
      {{"int", "int32"}, scalar_bytes(std::int32_t{-70000}), scalar_bytes(std::int32_t{-70000}, true)},
      {{"uint", "uint32"}, scalar_bytes(std::uint32_t{4000000000}), scalar_bytes(std::uint32_t{4000000000}, true)},
      {{"float", "float32"}, scalar_bytes(0.1F), scalar_bytes(0.1F, true)},
      {{"double", "float64"}, scalar_bytes(0.1), scalar_bytes(0.1, true)}};
  const std::vector<double> expected = {-2, 254, -300, 65000, -70000, 4000000000, static_cast<double>(0.1F), 0.1};
  const std::vector<std::string> text = {"-2", "254", "-300", "65000", "-70000", "4000000000", "0.1", "0.1"};
  for (std::size_t i = 0; i < types.size(); ++i) {
    for (const std::string& name : types[i].names) {
      const std::string head = " 1.0\nelement vertex 1\nproperty " + name + " x\nend_header\n";
      const Mesh mesh = {{{expected[i]}}, {}};
      EXPECT_EQ(read_mesh(write_file("t.ply", "ply\nformat ascii" + head + text[i])), mesh) << name;
      EXPECT_EQ(read_mesh(write_file("t.ply", "ply\nformat binary_little_endian" + head + types[i].little)), mesh);
      const auto indexed =
          open_mesh(write_file("t.ply", "ply\nformat binary_big_endian" + head + types[i].big))->indexed();
      EXPECT_EQ(read_indexed(*indexed), mesh) << name;
    }
  }
}

struct Expected {
  std::string file;
  std::uint64_t vertices = 0, triangles = 0;
};

TEST(RealMeshes, HaveTheCountsOfTheManifest) {
  REEB_REQUIRE_MESHES();
  std::ifstream manifest(test::mesh_folder() + "/MANIFEST.tsv");
  std::string line;
  std::getline(manifest, line);
  std::size_t read = 0;
  while (std::getline(manifest, line)) {
    std::istringstream fields(line);
    Expected expected;
    std::uint64_t bytes = 0, tetrahedra = 0;
    fields >> expected.file >> bytes >> expected.vertices >> expected.triangles >> tetrahedra;
    if (tetrahedra != 0) continue;
    SCOPED_TRACE(expected.file);
    const auto reader = open_mesh(test::mesh_folder() + "/" + expected.file);
    std::uint64_t vertices = 0, triangles = 0;
    for (MeshBatch batch; reader->read(batch);) {
      vertices += batch.vertex_count;
      triangles += batch.triangle_count();
    }
    EXPECT_EQ(vertices, expected.vertices);
    EXPECT_EQ(triangles, expected.triangles);
    EXPECT_EQ(reader->info().vertex_count.value_or(vertices), vertices);
    ++read;
  }
  EXPECT_GE(read, 15u);
}

}  // namespace
}  // namespace reeb::io::testing
