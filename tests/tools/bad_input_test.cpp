// Bad meshes of every format, through the program: exit code 1, one error line with the position, one hint, and nothing
// left behind. Formats without a count or an index cannot have a bad one.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <regex>

#include "tests/support/seed.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

// What to write in each format; the defaults are a good mesh of four triangles.
struct Content {
  double second_x = 1;            // x of vertex 1
  std::uint64_t last_corner = 2;  // last corner of the last triangle
  std::uint64_t vertices_said = 4, triangles_said = 4;
};

constexpr double kPoints[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::uint64_t kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

double coordinate(const Content& content, std::size_t vertex, std::size_t k) {
  return vertex == 1 && k == 0 ? content.second_x : kPoints[vertex][k];
}

std::uint64_t corner(const Content& content, std::size_t face, std::size_t c) {
  return face == 3 && c == 2 ? content.last_corner : kFaces[face][c];
}

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string point_text(const Content& content, std::size_t vertex) {
  return number(coordinate(content, vertex, 0)) + " " + number(coordinate(content, vertex, 1)) + " " +
         number(coordinate(content, vertex, 2)) + "\n";
}

std::string ply_header(const Content& content, const char* kind) {
  return std::string("ply\nformat ") + kind + " 1.0\nelement vertex " + std::to_string(content.vertices_said) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(content.triangles_said) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

// The faces as ascii PLY and OFF have them.
std::string face_lines(const Content& content) {
  std::string lines;
  for (std::size_t f = 0; f < 4; ++f) {
    lines += "3";
    for (std::size_t c = 0; c < 3; ++c) lines.append(" ").append(std::to_string(corner(content, f, c)));
    lines += "\n";
  }
  return lines;
}

std::string ply_text(const Content& content) {
  std::string file = ply_header(content, "ascii");
  for (std::size_t v = 0; v < 4; ++v) file += point_text(content, v);
  return file + face_lines(content);
}

std::string ply_binary(const Content& content) {
  std::string file = ply_header(content, "binary_little_endian");
  for (std::size_t v = 0; v < 4; ++v)
    for (std::size_t k = 0; k < 3; ++k) file += bytes_of(static_cast<float>(coordinate(content, v, k)));
  for (std::size_t f = 0; f < 4; ++f) {
    file += bytes_of(std::uint8_t{3});
    for (std::size_t c = 0; c < 3; ++c) file += bytes_of(static_cast<std::int32_t>(corner(content, f, c)));
  }
  return file;
}

std::string obj(const Content& content) {
  std::string file;
  for (std::size_t v = 0; v < 4; ++v) file += "v " + point_text(content, v);
  for (std::size_t f = 0; f < 4; ++f) {
    file += "f";
    for (std::size_t c = 0; c < 3; ++c) file.append(" ").append(std::to_string(corner(content, f, c) + 1));
    file += "\n";
  }
  return file;
}

std::string off(const Content& content) {
  std::string file =
      "OFF\n" + std::to_string(content.vertices_said) + " " + std::to_string(content.triangles_said) + " 0\n";
  for (std::size_t v = 0; v < 4; ++v) file += point_text(content, v);
  return file + face_lines(content);
}

std::string stl_text(const Content& content) {
  std::string file = "solid s\n";
  for (const auto& face : kFaces) {
    file += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint64_t v : face) file += "vertex " + point_text(content, v);
    file += "endloop\nendfacet\n";
  }
  return file + "endsolid s\n";
}

std::string stl_binary(const Content& content) {
  std::string file = std::string(80, ' ') + bytes_of(static_cast<std::uint32_t>(content.triangles_said));
  for (const auto& face : kFaces) {
    for (int i = 0; i < 3; ++i) file += bytes_of(0.0F);
    for (const std::uint64_t v : face)
      for (std::size_t k = 0; k < 3; ++k) file += bytes_of(static_cast<float>(coordinate(content, v, k)));
    file += std::string(2, '\0');
  }
  return file;
}

struct Format {
  const char* name;
  std::string (*make)(const Content&);
  bool has_indices, has_vertex_count, has_triangle_count;
};

constexpr Format kFormats[] = {
    {"PlyText", ply_text, true, true, true},    {"PlyBinary", ply_binary, true, true, true},
    {"Obj", obj, true, false, false},           {"Off", off, true, true, true},
    {"StlText", stl_text, false, false, false}, {"StlBinary", stl_binary, false, false, true},
};

// A run on a bad file must not take more than this, whatever the file announces.
constexpr std::uint64_t kMaxPeakBytes = 64u << 20;
constexpr double kMaxRunSeconds = 5;

class BadInput : public ProgramTest {
 protected:
  // Expects the error, and only the input in the folder afterwards.
  void expect_refused(const std::string& mesh, bool has_position) {
    const std::vector<std::string> before = files();
    const Outcome outcome = reeb({"compute", mesh, "--report", "report.json"});
    expect_error(outcome, 1, mesh + ":");
    if (has_position) {
      const std::regex place("reeb: error: " + mesh + ":[0-9]+(:[0-9]+)?: [^\n]+\n");
      EXPECT_TRUE(std::regex_search(outcome.error, place)) << last_command() << '\n' << outcome.error;
    }
    EXPECT_EQ(files(), before) << last_command();
    EXPECT_LT(outcome.seconds, kMaxRunSeconds) << last_command();
    if (!kSanitized) {
      EXPECT_LT(outcome.peak_rss_bytes, kMaxPeakBytes) << last_command();
    }
  }

  std::string gzipped(const std::string& name) const {
    const Outcome outcome = run_process({.arguments = {"gzip", "-c", in_folder(name)}});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    return outcome.output;
  }
};

class BadMesh : public BadInput, public testing::WithParamInterface<Format> {
 protected:
  // The same bytes as a file, gzipped, and from standard input.
  void expect_refused_in_every_wrapping(const std::string& bytes) {
    write("bad.mesh", bytes);
    expect_refused("bad.mesh", true);
    write("bad.mesh.gz", gzipped("bad.mesh"));
    expect_refused("bad.mesh.gz", true);
    Command command;
    command.input = in_folder("bad.mesh");
    expect_error(reeb({"compute", "-"}, command), 1);
  }

  static std::string make(const Content& content) { return GetParam().make(content); }
};

// Formats with corners that are numbers of vertices, and formats with counts.
class BadIndex : public BadMesh {};
class BadCount : public BadMesh {};

TEST_P(BadMesh, TheGoodOneIsRead) {
  write("good.mesh", make({}));
  expect_success(reeb({"compute", "good.mesh"}));
  write("good.mesh.gz", gzipped("good.mesh"));
  expect_success(reeb({"compute", "good.mesh.gz", "--force"}));
}

TEST_P(BadMesh, Truncated) {
  const std::string whole = make({});
  // Cuts the file in the second-last number. An OBJ file is only known to be cut if it ends within a vertex.
  const std::size_t length = std::string(GetParam().name) == "Obj" ? whole.find("v 0 0 1") + 5 : whole.size() - 20;
  expect_refused_in_every_wrapping(whole.substr(0, length));
}

TEST_P(BadMesh, TruncatedWithinTheCompression) {
  write("whole", make({}));
  const std::string whole = gzipped("whole");
  write("cut.gz", whole.substr(0, whole.size() - 12));
  expect_refused("cut.gz", true);
}

TEST_P(BadMesh, NotANumber) {
  expect_refused_in_every_wrapping(make({.second_x = std::numeric_limits<double>::quiet_NaN()}));
}

TEST_P(BadMesh, Infinite) {
  expect_refused_in_every_wrapping(make({.second_x = std::numeric_limits<double>::infinity()}));
}

TEST_P(BadIndex, IndexOutOfRange) {
  expect_refused_in_every_wrapping(make({.last_corner = 4}));
  expect_refused_in_every_wrapping(make({.last_corner = 2'000'000'000}));
}

TEST_P(BadCount, WrongCount) {
  expect_refused_in_every_wrapping(make({.triangles_said = 5}));
  // In a binary file nothing marks a record as a vertex, so a wrong count shows only as trailing data (tested below).
  const bool is_binary = std::string(GetParam().name) == "PlyBinary";
  if (GetParam().has_vertex_count && !is_binary) expect_refused_in_every_wrapping(make({.vertices_said = 5}));
}

TEST_P(BadCount, AnnouncesFarMoreThanItHolds) {
  expect_refused_in_every_wrapping(make({.triangles_said = 800'000'000}));
  if (!GetParam().has_vertex_count) return;
  expect_refused_in_every_wrapping(make({.vertices_said = 800'000'000}));
  expect_refused_in_every_wrapping(make({.vertices_said = 800'000'000, .triangles_said = 1'600'000'000}));
  expect_refused_in_every_wrapping(make({.vertices_said = std::numeric_limits<std::uint64_t>::max()}));
}

std::vector<Format> formats_with(bool Format::*feature) {
  std::vector<Format> formats;
  std::copy_if(std::begin(kFormats), std::end(kFormats), std::back_inserter(formats),
               [&](const Format& format) { return format.*feature; });
  return formats;
}

std::string format_name(const testing::TestParamInfo<Format>& format) { return format.param.name; }

INSTANTIATE_TEST_SUITE_P(Formats, BadMesh, testing::ValuesIn(kFormats), format_name);
INSTANTIATE_TEST_SUITE_P(Formats, BadIndex, testing::ValuesIn(formats_with(&Format::has_indices)), format_name);
INSTANTIATE_TEST_SUITE_P(Formats, BadCount, testing::ValuesIn(formats_with(&Format::has_triangle_count)), format_name);

// The size of a packed file says nothing.
TEST_F(BadInput, MemoryOfAnImageGrowsAsItsValuesCome) {
  write("v.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8192 8192 16\nencoding: raw\n\n123456");
  write("v.nrrd.gz", gzipped("v.nrrd"));
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--nodata", "skip"}}) {
    std::vector<std::string> words{"compute", "v.nrrd.gz", "-o", "v.reeb"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = reeb(words);
    expect_error(outcome, 1, "v.nrrd.gz:");
    if (!kSanitized) {
      EXPECT_LT(outcome.peak_rss_bytes, kMaxPeakBytes) << last_command();
    }
  }
}

TEST_F(BadInput, Empty) {
  write("empty.ply", "");
  expect_refused("empty.ply", false);
  write("empty.ply.gz", gzipped("empty.ply"));
  expect_refused("empty.ply.gz", false);
  expect_error(reeb({"compute", "-"}), 1);
  write("empty.dat", "");
  expect_refused("empty.dat", false);
}

// CX and OBJ have no header.
TEST_F(BadInput, AFileWithoutBytesCanBeAMeshWithoutVertices) {
  write("e.dat", "");
  for (const std::string format : {"cx", "obj"}) {
    const std::string name = "e." + format;
    write(name, "");
    write(name + ".gz", gzipped("e.dat"));
    for (const std::vector<std::string>& mesh :
         std::vector<std::vector<std::string>>{{name}, {name + ".gz"}, {"-", "--format", format}}) {
      std::vector<std::string> words{"compute", "-o", "e.reeb", "--force"};
      words.insert(words.end(), mesh.begin(), mesh.end());
      expect_success(reeb(words));
      EXPECT_EQ(lines_after("n ", reeb({"extract", "e.reeb"}).output).size(), 0u);
    }
    expect_success(reeb({"compute", "e.dat", "--format", format, "-o", "e.reeb", "--force"}));
    expect_success(reeb({"info", name}));
    expect_success(reeb({"defects", name}));
    expect_success(reeb({"repair", name, "--all", "-o", "repaired-" + format + ".ply"}));
    expect_success(reeb({"convert", name, format + ".ply"}));
    write(name + ".gz", "");  // not even packed
    expect_error(reeb({"compute", name + ".gz", "-o", "z.reeb"}), 1, name + ".gz:0: the file is empty");
  }
  expect_error(reeb({"compute", "e.dat", "--format", "ply", "-o", "z.reeb"}), 1, "e.dat:0: the file is empty");
  expect_error(reeb({"compute", "-", "--format", "sma", "-o", "z.reeb"}), 1, "standard input:0: TRUNCATED: ");
}

TEST_F(BadInput, ANumberBeyond64BitsIsTooLarge) {
  write("m.obj", "v 0 0 0\nv 1 0 0\nf 1 2 99999999999999999999\n");
  expect_error(reeb({"compute", "m.obj", "--quiet"}), 1,
               "m.obj:3:7: a vertex number of more than 18 digits is too large");
  write("m.cx", "v 0\nv 1\ns 0 99999999999999999999\n");
  expect_error(reeb({"compute", "m.cx", "--quiet"}), 1, "m.cx:3:5: a vertex index of more than 18 digits is too large");
}

TEST_F(BadInput, LinesThatEndWithCarriageReturnsAlone) {
  const std::string obj = "# c\rv 0 0 0\rv 1 0 0\rv 0 1 1\rf 1 2 3\r", ply = ply_header({}, "ascii") + "0 0 0\n";
  std::string old_ply = ply;
  std::ranges::replace(old_ply, '\n', '\r');
  write("m.obj", obj);
  write("m.ply", old_ply);
  write("m.off", "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 1\r3 0 1 2\r");
  write("m.sma", "# nverts 3\rv 0 0 0\rv 1 0 0\rv 0 1 1\rf 1 2 3\r");
  expect_error(reeb({"compute", "m.obj"}), 1, "m.obj:1:4: its lines end with CR alone");
  expect_error(reeb({"compute", "m.ply"}), 1, "m.ply:1:4: its lines end with CR alone");
  expect_error(reeb({"compute", "m.off"}), 1, "m.off:1:4: its lines end with CR alone");
  expect_error(reeb({"compute", "m.sma"}), 1, "m.sma:1:11: UNSUPPORTED: its lines end with CR alone");
  write("one.cx", "v 0 0 0\r");  // one line without its end
  expect_success(reeb({"compute", "one.cx"}));
  // In these formats it is a blank.
  write("m.mesh",
        "MeshVersionFormatted 2\rDimension 3\rVertices 3\r0 0 0 0\r1 0 0 0\r0 1 0 0\rTriangles 1\r1 2 3 0\rEnd\r");
  expect_success(reeb({"compute", "m.mesh"}));
  write("m.vtp",
        "<?xml version=\"1.0\"?>\r<VTKFile type=\"PolyData\" version=\"0.1\">\r<PolyData>\r<Piece "
        "NumberOfPoints=\"3\" NumberOfPolys=\"1\">\r<Points>\r<DataArray type=\"Float32\" NumberOfComponents=\"3\" "
        "format=\"ascii\">\r0 0 0\r1 0 0\r0 1 0\r</DataArray>\r</Points>\r<Polys>\r<DataArray type=\"Int32\" "
        "Name=\"connectivity\" format=\"ascii\">\r0 1 2\r</DataArray>\r<DataArray type=\"Int32\" Name=\"offsets\" "
        "format=\"ascii\">\r3\r</DataArray>\r</Polys>\r</Piece>\r</PolyData>\r</VTKFile>\r");
  expect_success(reeb({"compute", "m.vtp", "-o", "vtp.reeb"}));
}

// The classes of errors of streaming meshes.
TEST_F(BadInput, DamagedCompressionOfAStream) {
  std::string whole = "# nverts 3\nv 0 0 0\nv 1 0 0\nv 0 1 1\nf -1 -2 -3\n";
  write("m.sma", whole);
  whole = gzipped("m.sma");
  write("cut.sma.gz", whole.substr(0, whole.size() - 12));
  expect_error(reeb({"compute", "cut.sma.gz"}), 1,
               "cut.sma.gz:" + std::to_string(whole.size() - 12) + ": TRUNCATED: the compressed data");
  write("bad.sma.gz", whole.substr(0, 10) + std::string(14, '\0'));
  expect_error(reeb({"compute", "bad.sma.gz"}), 1, "bad.sma.gz:24: UNSUPPORTED: the compressed data");
}

TEST_F(BadInput, Directory) {
  std::filesystem::create_directory(in_folder("folder.ply"));
  expect_refused("folder.ply", false);
}

TEST_F(BadInput, NotThere) { expect_refused("missing.ply", false); }

TEST_F(BadInput, Unreadable) {
  write("secret.off", kSmallOff);
  ASSERT_EQ(::chmod(in_folder("secret.off").c_str(), 0), 0);
  Command command;
  // Root can read every file, so it has to drop that capability.
  if (::geteuid() == 0) command.wrapper = {"setpriv", "--bounding-set=-dac_override,-dac_read_search"};
  expect_error(reeb({"compute", "secret.off"}, command), 1, "secret.off");
}

TEST_F(BadInput, UnknownFormat) {
  write("picture.ply", "\x89PNG\r\n\x1a\n" + std::string(2000, '\x07'));
  expect_refused("picture.ply", false);
  write("letter.ply", "Dear all,\nthis is no mesh.\n");
  expect_refused("letter.ply", false);
  write("letter.ply.gz", gzipped("letter.ply"));
  expect_refused("letter.ply.gz", false);
}

TEST_F(BadInput, FilesOfOtherKindsAreNamed) {
  const std::string rest(2000, '\x07');
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {std::string("\x1c\2\0\0n+2\0", 8) + rest, "a NIfTI-2 image"},
      {std::string("\x1c\2\0\0ni2\0", 8) + rest, "a NIfTI-2 header"},
      {std::string("glTF\2\0\0\0", 8) + rest, "a binary glTF scene"},
      {"Kaydara FBX Binary  " + rest, "an FBX scene"},
      {"\x89HDF\r\n\x1a\n" + rest, "an HDF5 file"},
      {"REEBNAM\n" + rest, "a file of names of `reeb fragment --scan`"},
      {std::string("\xFE\xFF\0p\0l\0y", 8), "text in UTF-16"},
      {"\xFF\xD8\xFF" + rest, "a JPEG picture"},
      {std::string("MM\0*", 4) + rest, "a TIFF picture"},
      {"%PDF-1.7\n" + rest, "a PDF document"},
      {"PK\3\4" + rest, "a ZIP archive"},
      {"7z\xBC\xAF\x27\x1C" + rest, "a 7-Zip archive"},
      {std::string("\xFD\x37zXZ\0", 6) + rest, "packed with xz"},
      {"BZh91AY&SY" + rest, "packed with bzip2"},
      {std::string(257, '\0') + "ustar" + rest, "a tar archive"},
      {"<?xml version=\"1.0\"?>\n<COLLADA>\n", "a COLLADA scene"},
      {"\n<!DOCTYPE html>\n", "a web page"},
      {"<html>\n", "a web page"},
      {"<?xml version=\"1.0\"?>\n<a/>\n", "an XML file"},
      {"<?xml version=\"1.0\"?>\n<VTKFile type=\"RectilinearGrid\">\n", "a VTK XML file of another kind"},
      {std::string("\1\0\0\0\2\0\0\0\3\0\0\0", 12) + std::string(400, '\x22'), "a binary Medit mesh"},
      {"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n", "a Git LFS pointer"},
      {std::string("\xFF\xFEp\0l\0y\0", 8), "text in UTF-16"},
      {std::string(128, '\0') + "DICM" + std::string(2000, '\x02'), "a DICOM slice"},
      {std::string("II*\0", 4) + std::string(2000, '\x07'), "a TIFF picture"},
      {"\x89PNG\r\n\x1a\n" + std::string(2000, '\x07'), "a PNG picture"}};
  for (const auto& [bytes, name] : kinds) {
    write("file.ply", bytes);
    expect_error(reeb({"compute", "file.ply"}), 1, "file.ply:0: this is " + name);
    write("file.ply.gz", gzipped("file.ply"));
    expect_error(reeb({"compute", "file.ply.gz"}), 1, "file.ply.gz:0: this is " + name);
    expect_error(reeb({"pairs", "file.ply"}), 1, "file.ply: this is not a Reeb graph, but " + name);
  }
}

TEST_F(BadInput, PicturesAreToBeConverted) {
  write("slice.dcm", std::string(128, '\0') + "DICM" + std::string(2000, '\x02'));
  const Outcome slice = reeb({"compute", "slice.dcm"});
  expect_error(slice, 1, "slice.dcm:0: this is a DICOM slice, not a mesh");
  EXPECT_NE(slice.error.find("hint: convert the series to NRRD or NIfTI\n"), std::string::npos) << slice.error;
  write("a.png", "\x89PNG\r\n\x1a\n" + std::string(2000, '\x07'));
  const Outcome picture = reeb({"compute", "a.png"});
  expect_error(picture, 1, "a.png:0: this is a PNG picture, not a mesh");
  EXPECT_NE(picture.error.find("hint: convert it to NPY or NRRD\n"), std::string::npos) << picture.error;
}

// Whatever random bytes are taken for, it is nothing that a few bytes decide.
TEST_F(BadInput, RandomBytesAreOfUnknownFormat) {
  std::mt19937 random(base_seed());
  for (int first = 0; first < 5; ++first) {
    std::string bytes(3000, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    bytes[0] = static_cast<char>(first);
    bytes[1] = static_cast<char>(2 + random() % 250);
    write("noise.ply", bytes);
    if (first == 3) continue;  // SMC version 3 has no other mark
    expect_error(reeb({"compute", "noise.ply"}), 1, "noise.ply:0: unknown file format");
  }
}

TEST_F(BadInput, ABinaryStlHasTheSizeThatItAnnouncesOrIsNamedSo) {
  const std::string whole = stl_binary({});
  write("mesh", whole);
  expect_success(reeb({"mesh", "-o", "a.reeb"}));
  write("mesh", whole + "more");
  expect_error(reeb({"mesh"}), 1, "mesh:0: unknown file format");
  write("mesh.STL", whole + "more");
  expect_success(reeb({"mesh.STL", "-o", "b.reeb"}));
  write("mesh.stl", whole.substr(0, whole.size() - 20));
  expect_error(reeb({"mesh.stl"}), 1, "mesh.stl:80: the header announces 4 facets, but the file holds 3");
}

TEST_F(BadInput, TrailingDataIsNoted) {
  write("long.ply", ply_binary({.triangles_said = 3}));
  write("long.ply.gz", gzipped("long.ply"));
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  write("text.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
            corners + "3 0 1 2\n3 2 1 0\n");
  write("text.off", "OFF\n3 1 0\n" + corners + "3 0 1 2\n3 2 1 0\n");
  for (const std::string mesh : {"long.ply", "long.ply.gz", "text.ply", "text.off"}) {
    const Outcome outcome = reeb({"compute", mesh, "--force"});
    expect_success(outcome);
    EXPECT_EQ(lines_after("note: ", outcome.error).size(), 1u) << mesh << '\n' << outcome.error;
  }
}

TEST_F(BadInput, FileOfValues) {
  write("mesh.off", kSmallOff);
  for (const std::string values : {"1\n2\n3\n", "1\n2\nnan\n4\n", "1\ntwo\n3\n4\n"}) {
    write("values.txt", values);
    const std::vector<std::string> before = files();
    expect_error(reeb({"compute", "mesh.off", "-f", "file:values.txt"}), 1);
    EXPECT_EQ(files(), before);
  }
}

TEST_F(BadInput, AValueFileHasOneValueAVertexInEveryFormOfAMesh) {
  write("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 1\n0 1 2\n3 0 1 2\n");
  write("mesh.sma", "v 0 0 0\nv 1 0 1\nv 0 1 2\nf 1 2 3\nx 1\nx 2\nx 3\n");
  write("right.txt", "1\n2\n3\n");
  write("long.txt", "1\n2\n3\n4\n");
  for (const std::string mesh : {"mesh.off", "mesh.sma"}) {
    expect_success(reeb({"compute", mesh, "-f", "file:right.txt", "-o", mesh + ".reeb"}));
    const std::vector<std::string> before = files();
    expect_error(reeb({"compute", mesh, "-f", "file:long.txt"}), 1);
    EXPECT_EQ(files(), before);
  }
}

TEST_F(BadInput, MissingPropertyOrCoordinate) {
  write("mesh.off", kSmallOff);
  write("mesh.ply", ply_text({}));
  const std::vector<std::string> before = files();
  for (const std::string mesh : {"mesh.off", "mesh.ply"})
    for (const std::string function : {"property:quality", "c3", "file:missing.txt"})
      expect_error(reeb({"compute", mesh, "-f", function}), 1);
  EXPECT_EQ(files(), before);
}

TEST_F(BadInput, NotAReebFile) {
  write("mesh.off", kSmallOff);
  for (const char* command : {"extract", "pairs", "verify"}) {
    const Outcome outcome = reeb({command, "mesh.off"});
    expect_error(outcome, 1, "mesh.off: this is a mesh (OFF), not a Reeb graph");
    EXPECT_NE(outcome.error.find("`reeb mesh.off`, then `reeb " + std::string(command) + " mesh.reeb`"),
              std::string::npos)
        << outcome.error;
    expect_error(reeb({command, "missing.reeb"}), 1, "missing.reeb:");
    write("letter.reeb", "Dear all,\n");
    expect_error(reeb({command, "letter.reeb"}), 1, "letter.reeb: this is not a Reeb graph");
  }
}

TEST_F(BadInput, AReebFileIsNotReadFromAPipe) {
  write("mesh.off", kSmallOff);
  expect_success(reeb({"mesh.off"}));
  for (const std::string command : {"extract", "pairs", "verify", "plot"}) {
    const Outcome outcome =
        reeb({command, "/dev/stdin"}, {.arguments = {}, .wrapper = {"sh", "-c", "cat mesh.reeb | \"$@\"", "sh"}});
    expect_error(outcome, 2, "/dev/stdin: a Reeb graph cannot be read from a pipe");
    EXPECT_EQ(lines_after("hint: ", outcome.error).at(0), "name a .reeb file");
  }
}

TEST_F(BadInput, LinksThatLeadNowhereAndEmptyNamesAreSaid) {
  std::filesystem::create_symlink("loop", in_folder("loop"));
  expect_error(reeb({"compute", "loop"}), 1, "loop: this is a symbolic link that leads to itself");
  expect_error(reeb({"compute", ""}), 1, "the name of an input is empty");
}

TEST_F(BadInput, AReebFileIsNoMesh) {
  write("mesh.off", kSmallOff);
  expect_success(reeb({"mesh.off"}));
  // Whatever else is wrong, such as that the output exists.
  expect_error(reeb({"mesh.reeb"}), 1, "mesh.reeb: this is a Reeb graph already");
  expect_error(reeb({"convert", "mesh.reeb", "mesh.ply"}), 1, "mesh.reeb:0: this is a Reeb graph, not a mesh");
  expect_error(reeb({"verify", "mesh.reeb", "--mesh", "mesh.reeb"}), 1, "mesh.reeb: this is a Reeb graph, not a mesh");
}

}  // namespace
}  // namespace reeb::test
