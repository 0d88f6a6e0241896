// MetaImage headers and data.
#include <filesystem>

#include "tests/io/images/image_files.h"

namespace reeb::io::testing {
namespace {

using Values = std::vector<double>;
using Vectors = std::array<std::array<double, 3>, 3>;

const Values kSix = {0, 1, 2, 3, 4, 5};
const std::string kBytes = binary<std::uint8_t>({0, 1, 2, 3, 4, 5});

std::string meta(const std::string& type, const std::string& more = "", const std::string& file = "LOCAL") {
  return "ObjectType = Image\nNDims = 3\nDimSize = 3 2 1\nElementType = " + type + "\n" + more +
         "ElementDataFile = " + file + "\n";
}

Values values_of(const std::string& bytes) { return read_grid(write_file("a.mha", bytes)).values; }

template <class T>
void expect_type(const std::string& name) {
  const std::vector<T> stored = {
      0, 1, static_cast<T>(-2), std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest(), 5};
  const Values expected(stored.begin(), stored.end());
  SCOPED_TRACE(name);
  EXPECT_EQ(values_of(meta(name) + binary(stored)), expected);
  EXPECT_EQ(values_of(meta(name, "BinaryDataByteOrderMSB = False\n") + binary(stored)), expected);
  EXPECT_EQ(values_of(meta(name, "BinaryDataByteOrderMSB = True\n") + binary(stored, true)), expected);
  EXPECT_EQ(values_of(meta(name, "ElementByteOrderMSB = True\nCompressedData = True\nCompressedDataSize = 9\n") +
                      zlib_packed(binary(stored, true))),
            expected);
}

TEST(MetaImage, EveryTypeInBothByteOrders) {
  expect_type<std::int8_t>("MET_CHAR");
  expect_type<std::uint8_t>("MET_UCHAR");
  expect_type<std::int16_t>("MET_SHORT");
  expect_type<std::uint16_t>("MET_USHORT");
  expect_type<std::int32_t>("MET_INT");
  expect_type<std::uint32_t>("MET_UINT");
  expect_type<std::int32_t>("MET_LONG");
  expect_type<std::uint32_t>("MET_ULONG");
  expect_type<std::int64_t>("MET_LONG_LONG");
  expect_type<std::uint64_t>("MET_ULONG_LONG");
  expect_type<float>("MET_FLOAT");
  expect_type<double>("MET_DOUBLE");
}

TEST(MetaImage, DataAsText) {
  EXPECT_EQ(values_of(meta("MET_FLOAT", "BinaryData = False\n") + "0 1 2\n3 4 5\n"), kSix);
}

TEST(MetaImage, DataInAnotherFile) {
  std::filesystem::create_directories(scratch_folder() / "below");
  write_file("a.raw", "head" + kBytes);
  write_file("below/a.zraw", zlib_packed(kBytes));
  write_file("a.raw.gz", gzip_packed(kBytes));
  EXPECT_EQ(values_of(meta("MET_UCHAR", "HeaderSize = 4\n", "a.raw")), kSix);
  EXPECT_EQ(values_of(meta("MET_UCHAR", "HeaderSize = -1\n", "a.raw")), kSix);
  EXPECT_EQ(values_of(meta("MET_UCHAR", "CompressedData = True\n", "below/a.zraw")), kSix);
  EXPECT_EQ(values_of(meta("MET_UCHAR", "CompressedData = True\n", "a.raw.gz")), kSix);
}

// HeaderSize counts from the beginning of the file, also if the data are in it.
TEST(MetaImage, DataAtAPlaceOfThisFile) {
  for (const bool packed : {false, true}) {
    const std::string data = packed ? zlib_packed(kBytes) : kBytes;
    const auto with_size = [&](std::size_t size) {
      return meta("MET_UCHAR", std::string(packed ? "CompressedData = True\n" : "") + "HeaderSize = " +
                                   std::string(4 - std::to_string(size).size(), '0') + std::to_string(size) + "\n");
    };
    const std::size_t header = with_size(0).size();
    for (const std::size_t gap : {0u, 5u}) {
      const std::string text = with_size(header + gap);
      EXPECT_EQ(values_of(text + std::string(gap, 'x') + data), kSix) << packed << gap;
    }
  }
}

TEST(MetaImage, PositionsAndComponents) {
  Grid grid = read_grid(write_file("p.mha",
                                   "NDims = 3\nDimSize = 3 2 1\nElementType = MET_UCHAR\n"
                                   "ElementSpacing = 0.5 2 3\nPosition = 10 20 30\n"
                                   "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nCenterOfRotation = 0 0 0\n"
                                   "ElementDataFile = LOCAL\n" +
                                       kBytes));
  EXPECT_EQ(grid.info.format, "MetaImage");
  EXPECT_EQ(grid.info.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(grid.info.step, (Vectors{{{0, 0.5, 0}, {-2, 0, 0}, {0, 0, 3}}}));
  grid = read_grid(write_file("p.mha",
                              "ObjectType = Image\r\nNDims = 2\r\nDimSize = 1 2\r\nElementType = MET_UCHAR_ARRAY\r\n"
                              "ElementNumberOfChannels = 3\r\nElementSize = 2 4\r\nElementDataFile = LOCAL\r\n" +
                                  kBytes));
  EXPECT_EQ(grid.info.axes, 2u);
  EXPECT_EQ(grid.info.components, 3u);
  EXPECT_EQ(grid.info.step[1], (std::array<double, 3>{0, 4, 0}));
  EXPECT_EQ(grid.values, kSix);
}

TEST(MetaImage, BadFilesAreRefused) {
  const auto error = [](const std::string& bytes) { return error_of(write_file("bad.mhd", bytes)); };
  EXPECT_EQ(error(meta("MET_UCHAR") + "12345"),
            "bad.mhd:" + std::to_string(meta("MET_UCHAR").size()) +
                ": the header announces 6 values (6 bytes), but the file holds 5 bytes of data");
  EXPECT_EQ(error("NDims = 3\nDimSize = 3 2\n"), "bad.mhd:2:11: 2 values for 3 axes");
  EXPECT_EQ(error("NDims = 2\nElementSpacing = 1 1\nNDims = 3\n"), "bad.mhd:3:9: NDims is given twice");
  EXPECT_EQ(error("NDims = 2\nDimSize = 1 2\nDimSize = 1 2\n"), "bad.mhd:3:11: DimSize is given twice");
  EXPECT_EQ(error("NDims = 4\n"), "bad.mhd:1:9: the image has 4 axes");
  EXPECT_EQ(error("ObjectType = Tube\n"), "bad.mhd:1:14: this is not an image but \"Tube\"");
  EXPECT_EQ(error("NDims = 3\nDimSize = 3 2 1\n"),
            "bad.mhd:2:1: the header has no ElementDataFile, which must be its last line");
  EXPECT_EQ(error("NDims = 3\nElementDataFile = LOCAL\n"), "bad.mhd:2:1: the header has no ElementType");
  EXPECT_EQ(error(meta("MET_STRING")), "bad.mhd:4:15: values of type \"MET_STRING\" are not read");
  EXPECT_EQ(error(meta("MET_UCHAR", "BinaryData = perhaps\n")), "bad.mhd:5:14: \"perhaps\" is neither True nor False");
  EXPECT_EQ(error(meta("MET_UCHAR", "ElementSpacing = 1 inf 1\n")),
            "bad.mhd:5:20: \"inf\" is not a finite number (number of an axis)");
  for (const char* several : {"LIST", "slice%03d.raw 1 9 1"})
    EXPECT_EQ(error(meta("MET_UCHAR", "", several)),
              "bad.mhd:5:19: the data are spread over several files, which is not read");
  EXPECT_EQ(error(meta("MET_UCHAR", "", "../a.raw")),
            "bad.mhd: the data file \"../a.raw\" is not in the folder of the header");
  EXPECT_EQ(error(meta("MET_UCHAR", "", "/etc/passwd")),
            "bad.mhd: the data file \"/etc/passwd\" is not in the folder of the header");
  EXPECT_EQ(error(meta("MET_UCHAR", "", "missing.raw")).substr(0, 12), "missing.raw:");
  EXPECT_EQ(error(meta("MET_UCHAR", "HeaderSize = -1\nCompressedData = True\n") + kBytes),
            "bad.mhd: the header says that the data are the last bytes of a file whose size is not known");
}

}  // namespace
}  // namespace reeb::io::testing
