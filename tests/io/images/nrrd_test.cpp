// NRRD headers and data (http://teem.sourceforge.net/nrrd/format.html).
#include <cmath>
#include <filesystem>

#include "tests/io/images/image_files.h"

namespace reeb::io::testing {
namespace {

using Values = std::vector<double>;
using Vectors = std::array<std::array<double, 3>, 3>;

const Values kSix = {0, 1, 2, 3, 4, 5};

std::string nrrd(const std::string& fields, const std::string& data) {
  return "NRRD0004\n# by hand\n" + fields + "\n" + data;
}

std::string sized(const std::string& type, const std::string& encoding, const std::string& more = "") {
  return "dimension: 3\ntype: " + type + "\nsizes: 3 2 1\nencoding: " + encoding + "\n" + more;
}

Values read_nrrd(const std::string& fields, const std::string& data) {
  return read_grid(write_file("a.nrrd", nrrd(fields, data))).values;
}

template <class T>
void expect_type(const std::string& names) {
  const std::vector<T> stored = {
      0, 1, static_cast<T>(-2), std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest(), 5};
  const Values expected(stored.begin(), stored.end());
  std::stringstream each(names);
  for (std::string name; std::getline(each, name, ',');) {
    SCOPED_TRACE(name);
    EXPECT_EQ(read_nrrd(sized(name, "raw", "endian: little\n"), binary(stored)), expected);
    EXPECT_EQ(read_nrrd(sized(name, "raw", "endian: big\n"), binary(stored, true)), expected);
    EXPECT_EQ(read_nrrd(sized(name, "gzip", "endian: big\n"), gzip_packed(binary(stored, true))), expected);
  }
}

TEST(Nrrd, EveryTypeInBothByteOrders) {
  expect_type<std::int8_t>("signed char,int8,int8_t");
  expect_type<std::uint8_t>("uchar,unsigned char,uint8,uint8_t");
  expect_type<std::int16_t>("short,short int,signed short,signed short int,int16,int16_t");
  expect_type<std::uint16_t>("ushort,unsigned short,unsigned short int,uint16,uint16_t");
  expect_type<std::int32_t>("int,signed int,int32,int32_t");
  expect_type<std::uint32_t>("uint,unsigned int,uint32,uint32_t");
  expect_type<std::int64_t>("longlong,long long,long long int,signed long long,signed long long int,int64,int64_t");
  expect_type<std::uint64_t>("ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t");
  expect_type<float>("float");
  expect_type<double>("double");
}

TEST(Nrrd, EveryEncoding) {
  const std::string bytes = binary<std::uint8_t>({0, 1, 2, 3, 4, 5});
  EXPECT_EQ(read_nrrd(sized("uint8", "raw"), bytes), kSix);
  EXPECT_EQ(read_nrrd(sized("uint8", "gz"), gzip_packed(bytes)), kSix);
  EXPECT_EQ(read_nrrd(sized("uint8", "gzip"), zlib_packed(bytes)), kSix);
  EXPECT_EQ(read_nrrd(sized("uint8", "gzip"), gzip_packed(bytes.substr(0, 2)) + gzip_packed(bytes.substr(2))), kSix);
  EXPECT_EQ(read_nrrd(sized("uint8", "hex"), "0001 02\n030405\n"), kSix);
  EXPECT_EQ(read_nrrd(sized("float", "ascii"), "0 1\r\n2,3\n4 5"), kSix);
  EXPECT_EQ(read_nrrd(sized("float", "text"), "0 1 2 3 4 5\n"), kSix);
  const Values odd = read_nrrd(sized("float", "txt"), "nan -inf 2.5e1 3 4 -0\n");
  EXPECT_TRUE(std::isnan(odd[0]));
  EXPECT_EQ(odd[1], -INFINITY);
  EXPECT_EQ(odd[2], 25);
  EXPECT_FALSE(std::signbit(odd[5]));
}

// Also from packed files, which cannot seek.
TEST(Nrrd, SkipsLinesAndBytes) {
  const std::string bytes = binary<std::uint8_t>({0, 1, 2, 3, 4, 5});
  const auto expect_six = [](const std::string& encoding, const std::string& skip, const std::string& data) {
    const std::string fields = sized("uint8", encoding, skip);
    EXPECT_EQ(read_nrrd(fields, data), kSix) << skip;
    EXPECT_EQ(read_grid(write_file("a.nrrd.gz", gzip_packed(nrrd(fields, data)))).values, kSix) << skip;
    if (encoding == "gzip") return;  // a packed file of packed data is unpacked once
    write_file("a.raw.gz", gzip_packed(data));
    EXPECT_EQ(read_grid(write_file("a.nhdr", nrrd(fields + "data file: a.raw.gz\n", ""))).values, kSix) << skip;
  };
  expect_six("raw", "line skip: 2\nbyte skip: 3\n", "one\ntwo\nxyz" + bytes);
  expect_six("raw", "line skip: 1\n", std::string(300'000, 'a') + "\n" + bytes);
  expect_six("raw", "byte skip: 300000\n", std::string(300'000, 'a') + bytes);
  EXPECT_EQ(read_nrrd(sized("uint8", "raw", "byte skip: -1\n"), "anything" + bytes), kSix);
  // In packed data, bytes are skipped after unpacking.
  expect_six("gzip", "lineskip: 1\nbyteskip: 3\n", "one\n" + gzip_packed("xyz" + bytes));
  // In text and in hexadecimal digits, they are characters.
  expect_six("ascii", "line skip: 1\nbyte skip: 4\n", "one\n9 9 0 1 2 3 4 5\n");
  expect_six("ascii", "byte skip: 4\n", "9 9 0 1 2 3 4 5\n");
  expect_six("hex", "byte skip: 3\n", "ff\n000102030405\n");
  EXPECT_EQ(error_of(write_file("a.nrrd", nrrd(sized("uint8", "ascii", "byte skip: 6\n"), "9\n9 9 0 1 2 x 4 5\n"))),
            "a.nrrd:10:11: \"x\" is not a number (a value should be here)");
  EXPECT_EQ(error_of(write_file("a.nrrd", nrrd(sized("uint8", "ascii", "byte skip: 4\n"), "9 9 0 1 x 3 4 5\n"))),
            "a.nrrd:9:9: \"x\" is not a number (a value should be here)");
  EXPECT_EQ(
      error_of(write_file("a.nrrd", nrrd(sized("uint8", "ascii", "byte skip: 90\n"), "0 1 2 3 4 5\n"))).substr(0, 6),
      "a.nrrd");
}

TEST(Nrrd, DataInAnotherFile) {
  const std::string bytes = binary<std::uint8_t>({0, 1, 2, 3, 4, 5});
  std::filesystem::create_directories(scratch_folder() / "below");
  write_file("a b.raw", "head" + bytes);
  write_file("below/a.raw", bytes);
  write_file("a.raw.gz", gzip_packed(bytes));
  const auto read = [](const std::string& fields) { return read_grid(write_file("a.nhdr", nrrd(fields, ""))).values; };
  EXPECT_EQ(read(sized("uint8", "raw", "byte skip: 4\ndata file: a b.raw\n")), kSix);
  EXPECT_EQ(read(sized("uint8", "raw", "byte skip: -1\ndatafile: ./a b.raw\n")), kSix);
  EXPECT_EQ(read(sized("uint8", "raw", "data file: below/a.raw\n")), kSix);
  EXPECT_EQ(read(sized("uint8", "gzip", "data file: a.raw.gz\n")), kSix);
  EXPECT_EQ(read(sized("uint8", "raw", "data file: a.raw.gz\n")), kSix);
}

TEST(Nrrd, PositionsOfVertices) {
  const auto info_of = [](const std::string& fields, std::size_t values) {
    return read_grid(write_file("a.nrrd", nrrd(fields, std::string(values, '\1')))).info;
  };
  const std::string volume = "type: uint8\nencoding: raw\ndimension: 3\nsizes: 2 3 4\n";
  GridInfo info = info_of(volume, 24);
  EXPECT_EQ(info.format, "NRRD raw");
  EXPECT_EQ(info.axes, 3u);
  EXPECT_EQ(info.size, (std::array<std::uint64_t, 3>{2, 3, 4}));
  EXPECT_EQ(info.step, (Vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));

  info = info_of(volume + "spacings: 0.5 2 -3\naxis mins: 10 20 30\n", 24);
  EXPECT_EQ(info.step, (Vectors{{{0.5, 0, 0}, {0, 2, 0}, {0, 0, -3}}}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{10, 20, 30}));

  info = info_of(volume + "axis mins: 0 0 0\naxis maxs: 2 6 8\ncenters: cell node cell\n", 24);
  EXPECT_EQ(info.step, (Vectors{{{1, 0, 0}, {0, 3, 0}, {0, 0, 2}}}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{0.5, 0, 1}));

  info = info_of(volume +
                     "space: left-posterior-superior\nspace directions: (0,1,0) (2, 0, 0) (0,0,3)\n"
                     "space origin: (-1,-2,-3)\n",
                 24);
  EXPECT_EQ(info.step, (Vectors{{{0, 1, 0}, {2, 0, 0}, {0, 0, 3}}}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{-1, -2, -3}));

  const std::string picture = "type: uint8\nencoding: raw\ndimension: 2\nsizes: 2 3\n";
  EXPECT_EQ(info_of(picture, 6).axes, 2u);
  info = info_of(picture + "space dimension: 2\nspace directions: (1,1) (-1,1)\n", 6);
  EXPECT_EQ(info.axes, 2u);
  EXPECT_EQ(info.step[1], (std::array<double, 3>{-1, 1, 0}));
  // A slice in space has three coordinates.
  info = info_of(picture + "space dimension: 3\nspace directions: (1,0,1) (0,1,0)\nspace origin: (0,0,7)\n", 6);
  EXPECT_EQ(info.axes, 3u);
  EXPECT_EQ(info.size, (std::array<std::uint64_t, 3>{2, 3, 1}));
  EXPECT_EQ(info.origin[2], 7);
}

TEST(Nrrd, ComponentsAreTheFirstAxis) {
  const std::string data = binary<std::uint8_t>({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  const std::string head = "type: uint8\nencoding: raw\n";
  Grid grid =
      read_grid(write_file("c.nrrd", nrrd(head + "dimension: 4\nsizes: 3 2 2 1\nkinds: vector domain domain domain\n"
                                                 "spacings: nan 1 2 3\n",
                                          data)));
  EXPECT_EQ(grid.info.components, 3u);
  EXPECT_EQ(grid.info.size, (std::array<std::uint64_t, 3>{2, 2, 1}));
  EXPECT_EQ(grid.info.step[2][2], 3);
  EXPECT_EQ(grid.values, (Values{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  grid = read_grid(write_file("c.nrrd", nrrd(head + "dimension: 4\nsizes: 2 3 2 1\nspace dimension: 3\n"
                                                    "space directions: none (1,0,0) (0,1,0) (0,0,1)\n",
                                             data)));
  EXPECT_EQ(grid.info.components, 2u);
  EXPECT_EQ(grid.info.axes, 3u);
  grid =
      read_grid(write_file("c.nrrd", nrrd(head + "dimension: 3\nsizes: 3 2 2\nkinds: RGB-color space space\n", data)));
  EXPECT_EQ(grid.info.components, 3u);
  EXPECT_EQ(grid.info.axes, 2u);
  grid = read_grid(write_file("c.nrrd", nrrd(head + "dimension: 4\nsizes: 3 2 2 1\n", data)));
  EXPECT_EQ(grid.info.components, 1u);
  EXPECT_EQ(grid.info.axes, 3u);
}

TEST(Nrrd, PlacesOfVertices) {
  auto reader = open_grid(write_file("p.nrrd", nrrd(sized("short", "raw", "endian: big\n"), std::string(12, '\0'))));
  const std::uint64_t data = std::filesystem::file_size(scratch_folder() / "p.nrrd") - 12;
  EXPECT_EQ(reader->place_of(4).position, std::to_string(data + 8));
  EXPECT_EQ(reader->place_of(4).file, (scratch_folder() / "p.nrrd").string());
  // Six lines of header and an empty one.
  reader = open_grid(write_file("p.nrrd", nrrd(sized("short", "ascii"), "0 1 2\n3 44 5\n")));
  EXPECT_EQ(reader->place_of(5).position, "9:6");
}

TEST(Nrrd, BadHeadersAndDataAreRefused) {
  const auto error = [](const std::string& fields, const std::string& data = {}) {
    return error_of(write_file("bad.nrrd", nrrd(fields, data)));
  };
  EXPECT_EQ(error(sized("uint8", "raw"), "12345"),
            "bad.nrrd:72: the header announces 6 values (6 bytes), but the file holds 5 bytes of data");
  EXPECT_EQ(
      error("type: float\nencoding: raw\nendian: little\ndimension: 3\nsizes: 10000 10000 10000\n", "1234"),
      "bad.nrrd:99: the header announces 1,000,000,000,000 values (4,000,000,000,000 bytes), but the file holds 4 "
      "bytes of data");
  EXPECT_EQ(error("type: float\nencoding: gzip\nendian: little\ndimension: 2\nsizes: 1000000 1000000\n", "1234"),
            "bad.nrrd:98: the header announces 1,000,000,000,000 values (at least 3,875,968,992 bytes), but the file "
            "holds 4 bytes of data");
  EXPECT_EQ(error("type: uint8\nencoding: raw\ndimension: 3\nsizes: 4294967296 4294967296 4294967296\n"),
            "bad.nrrd: the header announces more than 2^56 values");
  EXPECT_EQ(error("type: uint8\nencoding: raw\ndimension: 2\nsizes: 99999999999999999999 2\n"),
            "bad.nrrd:6:8: too large: size");
  EXPECT_EQ(error("type: uint8\nencoding: raw\ndimension: 2\nsizes: -1 2\n"), "bad.nrrd:6:8: negative: size");
  EXPECT_EQ(error("type: uint8\nencoding: raw\ndimension: 2\nsizes: 0 2\n"),
            "bad.nrrd: an axis of the image has size 0");
  EXPECT_EQ(error("type: uint8\nencoding: raw\ndimension: 2\nsizes: 1 2 3\n"), "bad.nrrd:6:8: 3 values for 2 axes");
  EXPECT_EQ(error("type: uint8\nsizes: 1 2\n"), "bad.nrrd:4:1: the dimension must come before this");
  EXPECT_EQ(error_of(write_file("bad.nrrd", "NRRD0004\n" + sized("uint8", "raw"))),
            "bad.nrrd:5:1: no empty line ends the header");
  const std::string comment = "# " + std::string(70'000, 'x') + "\n";
  EXPECT_EQ(error(sized("uint8", "raw", comment), "123456"), "bad.nrrd:7:1: no empty line ends the header");
  EXPECT_EQ(error(sized("uint8", "raw", "data file: a.raw\n" + comment)),
            "bad.nrrd:8:1: no empty line ends the header");
  EXPECT_EQ(error("type: block\n"), "bad.nrrd:3:7: values of type \"block\" are not read");
  EXPECT_EQ(error("dimension: 1\ntype: uint8\nencoding: raw\nsizes: 3\n", "123"), "bad.nrrd: the image has 1 axis");
  EXPECT_EQ(error("dimension: 4\ntype: uint8\nencoding: raw\nsizes: 1 1 2 3\n"), "bad.nrrd:1:1: the image has 4 axes");
  EXPECT_EQ(error("dimension: 4\ntype: uint8\nencoding: raw\nsizes: 1 1 1 3\nspace dimension: 3\n"
                  "space directions: (1,0,0) (0,1,0) (0,0,1) none\n"),
            "bad.nrrd:9:1: an axis of components is not the first axis");
  EXPECT_EQ(error(sized("short", "raw"), std::string(12, '1')),
            "bad.nrrd:7:1: the header has no endian, which values of more than one byte need");
  EXPECT_EQ(error(sized("uint8", "bzip2")), "bad.nrrd:7:1: data of the encoding \"bzip2\" are not read");
  EXPECT_EQ(error(sized("uint8", "ascii"), "1 2 x 4 5 6"),
            "bad.nrrd:8:5: \"x\" is not a number (a value should be here)");
  EXPECT_EQ(error(sized("uint8", "ascii"), "1 2 3 4 5       "), "bad.nrrd:8:17: the file ends after 5 of 6 values");
  EXPECT_EQ(error(sized("uint8", "hex"), "000102030z0  "), "bad.nrrd:81: not a hexadecimal digit");
  EXPECT_EQ(error(sized("uint8", "raw", "space origin: 1 2 3\n")), "bad.nrrd:7:15: not a vector \"(x,y,z)\"");
  EXPECT_EQ(error(sized("uint8", "raw", "spacings: 1 inf 1\n")),
            "bad.nrrd:7:13: \"inf\" is not a finite number (number of an axis)");
  const std::string packed = gzip_packed(std::string(6, '1'));
  EXPECT_EQ(error(sized("uint8", "gzip"), packed.substr(0, 12)), "bad.nrrd:85: the packed data end too early");
  EXPECT_EQ(error(sized("uint8", "gzip"), packed.substr(0, 10) + "\xFF\xFF"),
            "bad.nrrd:84: the packed data are damaged: invalid block type");
  EXPECT_EQ(error(sized("uint8", "gzip"), gzip_packed("12345")), "bad.nrrd:98: the file ends after 5 of 6 values");
}

TEST(Nrrd, DataFilesElsewhereAreRefused) {
  const auto error = [](const std::string& name) {
    return error_of(write_file("bad.nhdr", nrrd(sized("uint8", "raw", "data file: " + name + "\n"), "")));
  };
  write_file("secret", "123456");
  std::filesystem::create_directories(scratch_folder() / "below");
  EXPECT_EQ(error(scratch_folder().string() + "/secret").substr(0, 25), "bad.nhdr: the data file \"");
  EXPECT_EQ(error("below/../secret"), "bad.nhdr: the data file \"below/../secret\" is not in the folder of the header");
  EXPECT_EQ(error("nowhere.raw").substr(0, 12), "nowhere.raw:");
  EXPECT_EQ(error("LIST"), "bad.nhdr:7:12: the data are spread over several files, which is not read");
  EXPECT_EQ(error("a%02d.raw 1 9 1"), "bad.nhdr:7:12: the data are spread over several files, which is not read");
}

TEST(Nrrd, DataAfterTheLastValueAreAWarning) {
  auto reader = open_grid(write_file("more.nrrd", nrrd(sized("uint8", "raw"), "1234567")));
  read_grid(*reader);
  EXPECT_EQ(reader->warnings(), std::vector<std::string>{"data after the last value were ignored"});
}

TEST(Nrrd, IntegersThatNoDoubleHoldsAreCounted) {
  const std::vector<std::uint64_t> stored = {
      1, std::uint64_t{1} << 53, (std::uint64_t{1} << 53) + 1, std::uint64_t{1} << 63, ~std::uint64_t{0}, 5};
  auto reader = open_grid(write_file("wide.nrrd", nrrd(sized("uint64", "raw", "endian: little\n"), binary(stored))));
  std::vector<double> values(6);
  EXPECT_EQ(reader->read(values), 6u);
  EXPECT_EQ(reader->warnings(), std::vector<std::string>{"2 values beyond 2^53 were rounded to the nearest double"});
}

}  // namespace
}  // namespace reeb::io::testing
