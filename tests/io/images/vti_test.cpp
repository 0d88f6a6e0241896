// VTK XML image data.
#include "tests/io/images/vti_files.h"

namespace reeb::io::testing {
namespace {

using Values = std::vector<double>;

const std::string kImage = "WholeExtent=\"0 2 0 1 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";

std::vector<VtiForm> forms() {
  std::vector<VtiForm> all = {{.format = "ascii"}};
  for (const bool wide : {false, true})
    for (const bool big : {false, true})
      for (const char* packing : {"", "ZLib", "LZ4"}) {
        all.push_back({"appended", false, packing, wide, big});
        all.push_back({"appended", true, packing, wide, big});
        all.push_back({"binary", false, packing, wide, big});
      }
  // Blocks that are all whole.
  for (const char* packing : {"ZLib", "LZ4"}) all.push_back({"appended", false, packing, false, false, 6});
  return all;
}

std::string name_of(const VtiForm& form) {
  return form.format + " " + form.packing + (form.base64 ? " base64" : "") + (form.wide_head ? " wide" : "") +
         (form.big_endian ? " big" : "");
}

template <class T>
void expect_type(const std::string& name) {
  const std::vector<T> stored = {
      0, 1, static_cast<T>(-2), std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest(), 5};
  for (const VtiForm& form : forms()) {
    SCOPED_TRACE(name + " " + name_of(form));
    std::ostringstream text;
    text.precision(17);
    for (const T value : stored) text << +value << (value == 1 ? "\n" : " ");
    const VtiArray array{"a", name, 1, binary(stored, form.big_endian), text.str()};
    const Grid grid = read_grid(write_file("a.vti", vti_file(kImage, {array}, form)));
    EXPECT_EQ(grid.values, Values(stored.begin(), stored.end()));
  }
}

TEST(Vti, EveryTypeInEveryForm) {
  expect_type<std::int8_t>("Int8");
  expect_type<std::uint8_t>("UInt8");
  expect_type<std::int16_t>("Int16");
  expect_type<std::uint16_t>("UInt16");
  expect_type<std::int32_t>("Int32");
  expect_type<std::uint32_t>("UInt32");
  expect_type<std::int64_t>("Int64");
  expect_type<std::uint64_t>("UInt64");
  expect_type<float>("Float32");
  expect_type<double>("Float64");
}

VtiArray array_of(const std::string& name, const std::vector<float>& values, unsigned components = 1) {
  std::string text;
  for (const float value : values) text += std::to_string(value) + " ";
  return {name, "Float32", components, binary(values), text};
}

TEST(Vti, ReadsTheActiveScalarsElseTheFirstArray) {
  const VtiArray first = array_of("first", {0, 1, 2, 3, 4, 5}), second = array_of("second", {9, 8, 7, 6, 5, 4});
  for (const VtiForm& form : forms()) {
    if (form.big_endian) continue;
    SCOPED_TRACE(name_of(form));
    const auto values = [&](const std::string& scalars) {
      return read_grid(write_file("s.vti", vti_file(kImage, {first, second}, form, scalars))).values;
    };
    EXPECT_EQ(values(""), (Values{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(values("first"), (Values{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(values("second"), (Values{9, 8, 7, 6, 5, 4}));
    EXPECT_EQ(values("third"), (Values{0, 1, 2, 3, 4, 5}));
  }
  const auto reader = open_grid(write_file("s.vti", vti_file(kImage, {first, second}, {}, "second")));
  EXPECT_EQ(reader->info().format, "VTI appended");
  EXPECT_EQ(reader->warnings(),
            std::vector<std::string>{"of the arrays of points, second is read; these are not: first"});
}

TEST(Vti, PositionsAndComponents) {
  const std::string image = "WholeExtent=\"-1 0 2 3 5 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 3\"";
  Grid grid = read_grid(write_file("p.vti", vti_file(image, {array_of("v", {0, 1, 2, 3, 4, 5, 6, 7}, 2)})));
  EXPECT_EQ(grid.info.components, 2u);
  EXPECT_EQ(grid.info.axes, 3u);
  EXPECT_EQ(grid.info.size, (std::array<std::uint64_t, 3>{2, 2, 1}));
  EXPECT_EQ(grid.info.origin, (std::array<double, 3>{9.5, 24, 45}));
  EXPECT_EQ(grid.info.step[1], (std::array<double, 3>{0, 2, 0}));
  // The rows of the matrix are x, y and z: i goes along y here.
  grid = read_grid(
      write_file("p.vti", vti_file(image + " Direction=\"0 -1 0 1 0 0 0 0 1\"", {array_of("v", {0, 1, 2, 3})})));
  EXPECT_EQ(grid.info.step[0], (std::array<double, 3>{0, 0.5, 0}));
  EXPECT_EQ(grid.info.step[1], (std::array<double, 3>{-2, 0, 0}));
  EXPECT_EQ(grid.info.origin, (std::array<double, 3>{10 - 4, 20 - 0.5, 45}));
}

// The document before the data is longer than a window, and packed files cannot go back.
TEST(Vti, LongDocuments) {
  const VtiArray array = array_of("a", {0, 1, 2, 3, 4, 5});
  for (const VtiForm& form : forms()) {
    if (form.big_endian) continue;
    SCOPED_TRACE(name_of(form));
    std::string file = vti_file(kImage, {array}, form);
    for (const std::size_t length : {65000u, 65536u, 200'000u}) {
      std::string longer = file;
      longer.insert(longer.find("<Piece"), "<!--" + std::string(length, 'x') + "-->");
      EXPECT_EQ(read_grid(write_file("l.vti", longer)).values, (Values{0, 1, 2, 3, 4, 5}));
      EXPECT_EQ(read_grid(write_file("l.vti.gz", gzip_packed(longer))).values, (Values{0, 1, 2, 3, 4, 5}));
    }
  }
}

TEST(Vti, PlacesOfVertices) {
  const std::string file = vti_file(kImage, {array_of("a", {0, 1, 2, 3, 4, 5})});
  EXPECT_EQ(open_grid(write_file("r.vti", file))->place_of(4).position,
            std::to_string(file.find("   _") + 4 + 4 + 4 * sizeof(float)));
  const auto packed = vti_file(kImage, {array_of("a", {0, 1, 2, 3, 4, 5})}, {.packing = "ZLib"});
  EXPECT_EQ(open_grid(write_file("r.vti", packed))->place_of(4).position, "");
  const VtiArray array{"a", "Float32", 1, "", "0 1 2\n3 nan 5"};
  const auto reader = open_grid(write_file("t.vti", vti_file(kImage, {array}, {.format = "ascii"})));
  EXPECT_EQ(reader->place_of(4).position, "9:3");
}

TEST(Vti, BadFilesAreRefused) {
  const VtiArray array = array_of("a", {0, 1, 2, 3, 4, 5});
  const auto error = [](const std::string& file) { return error_of(write_file("bad.vti", file)); };
  const auto changed = [&](const std::string& from, const std::string& to, const VtiForm& form = {}) {
    std::string file = vti_file(kImage, {array}, form);
    const std::size_t at = file.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error(file.replace(at, from.size(), to));
  };
  EXPECT_EQ(changed("0 2 0 1 0 0", "0 9999 0 9999 0 9999"), "bad.vti:5:1: the piece has another extent than the image");
  for (const char* extent : {"0 2 0 1 0 -9223372036854775808", "-9223372036854775808 2 0 1 0 0"})
    EXPECT_EQ(error(vti_file("WholeExtent=\"" + std::string(extent) + "\"", {array})).substr(0, 36),
              "bad.vti:3:15: an extent is not 6 int")
        << extent;
  const std::size_t data = vti_file(kImage, {array}).find("   _") + 4;
  std::string giant = vti_file("WholeExtent=\"0 9999 0 9999 0 9999\"", {array});
  EXPECT_EQ(error(giant), "bad.vti:" + std::to_string(giant.find("   _") + 4) +
                              ": the header announces 1,000,000,000,000 values (at least 4,000,000,000,004 bytes), but "
                              "the file holds 56 bytes of data");
  const std::string text = vti_file("WholeExtent=\"0 99 0 9 0 9\"", {array}, {.format = "ascii"});
  EXPECT_EQ(error(text), "bad.vti:0: the header announces 10,000 values (at least 19,999 bytes), but the file holds " +
                             std::to_string(text.size()) + " bytes of data");
  EXPECT_EQ(changed("Float32\" Name=\"a", "String\" Name=\"a"), "bad.vti:7:1: values of type \"String\" are not read");
  EXPECT_EQ(changed("Components=\"1", "Components=\"0"),
            "bad.vti:7:1: the array has \"0\" components; 1 to 4,096 are read");
  EXPECT_EQ(changed("offset=\"0", "offset=\"-1"), "bad.vti:7:1: the array has no valid offset in the appended data");
  EXPECT_EQ(changed("offset=\"0", "offset=\"999").substr(0, 30),
            "bad.vti:" + std::to_string(data + 999 + 2) + ": the header annou");
  EXPECT_EQ(changed("   _", "   x"),
            "bad.vti:" + std::to_string(data - 5) + ": the appended data do not begin with an underscore");
  EXPECT_EQ(changed("type=\"ImageData", "type=\"PolyData"), "bad.vti:0: this is not an image of a known format");
  EXPECT_EQ(changed("<CellData/>", "</CellData>"), "bad.vti:9:3: this is not valid XML: mismatched tag");
  EXPECT_EQ(changed("Origin=\"0 0 0", "Origin=\"0 0"), "bad.vti:3:15: Origin is not 3 numbers");
  EXPECT_EQ(changed("<?xml version=\"1.0\"?>", "<!DOCTYPE a [<!ENTITY b \"c\">]>"),
            "bad.vti:1:13: a document type is not read");
  EXPECT_EQ(changed("</Piece>", "</Piece><Piece Extent=\"0 2 0 1 0 0\"/>"),
            "bad.vti:10:9: the image is in several pieces");
  EXPECT_EQ(changed("<PointData>", "<CellData>", {.format = "ascii"}),
            "bad.vti:10:3: this is not valid XML: mismatched tag");
  std::string cells = vti_file(kImage, {array});
  for (const char* tag : {"<PointData>", "</PointData>"}) {
    const std::string other = std::string(tag[1] == '/' ? "</" : "<") + "CellData>";
    cells.replace(cells.find(tag), std::string(tag).size(), other);
  }
  EXPECT_TRUE(error(cells).ends_with(": the image has values of cells only, but those of points are read"));
}

TEST(Vti, WhatAFileListsHasALimit) {
  const VtiArray array = array_of("a", {0, 1, 2, 3, 4, 5});
  const std::string file = vti_file(kImage, {array});
  const auto error = [&file](const std::string& before, const std::string& more) {
    std::string longer = file;
    longer.insert(longer.find(before), more);
    return error_of(write_file("bad.vti", longer));
  };
  std::string tags, arrays;
  for (int i = 0; i < 100; ++i) tags += "<a>";
  EXPECT_NE(error("<Piece", tags).find("the file has more than 100 tags inside each other"), std::string::npos);
  for (int i = 0; i < 10000; ++i) arrays += "<DataArray type=\"Int8\" format=\"appended\" offset=\"0\"/>\n";
  EXPECT_NE(error("</PointData>", arrays).find("the file has more than 10,000 arrays"), std::string::npos);
}

TEST(Vti, DamagedDataAreRefused) {
  const VtiArray array = array_of("a", {0, 1, 2, 3, 4, 5});
  const auto error = [](const std::string& file) {
    const std::string text = error_of(write_file("bad.vti", file));
    return text.substr(std::min(text.size(), text.find(": ") + 2));
  };
  std::string file = vti_file(kImage, {array}, {.packing = "ZLib"});
  std::string damaged = file;
  damaged[file.find("   _") + 4 + 12 + 16 + 3] ^= 1;  // in the first block, after the head
  EXPECT_EQ(error(damaged), "block 1 of the array is damaged");
  damaged = file;
  damaged[file.find("   _") + 4] = 100;
  EXPECT_EQ(error(damaged), "the array has 696 bytes, but 24 are needed");
  damaged[file.find("   _") + 4 + 3] = 100;
  EXPECT_EQ(error(damaged), "the array has 1,677,721,700 blocks of 7 bytes, which is not a valid header");
  file = vti_file(kImage, {array}, {.packing = "LZ4"});
  file.resize(file.find("   _") + 4 + 40);
  EXPECT_EQ(error(file), "the data of the array end too early");
  file = vti_file(kImage, {array}, {.format = "binary"});
  file[file.find("\n  ", file.find("Name=\"a")) + 4] = '!';
  EXPECT_EQ(error(file), "this is not base64 text");
  file = vti_file(kImage, {array_of("a", {0, 1, 2, 3, 4})});
  EXPECT_EQ(error(file), "the array has 20 bytes, but 24 are needed");
  file = vti_file(kImage, {array_of("a", {0, 1, 2, 3, 4})}, {.format = "ascii"});
  EXPECT_EQ(error(file), "the file ends after 5 of 6 values");
}

}  // namespace
}  // namespace reeb::io::testing
