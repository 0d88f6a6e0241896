// ESRI ASCII grids.
#include <cmath>

#include "tests/io/images/image_files.h"

namespace reeb::io::testing {
namespace {

const std::string kHead = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n";

TEST(EsriGrid, VerticesAreCentresOfCellsFromNorthToSouth) {
  Grid grid = read_grid(write_file("a.asc", kHead + "0 1 2\n3 4.5 -9999\n"));
  EXPECT_EQ(grid.info.format, "ESRI ASCII grid");
  EXPECT_EQ(grid.values, (std::vector<double>{0, 1, 2, 3, 4.5, -9999}));
  EXPECT_EQ(grid.info.axes, 2u);
  EXPECT_EQ(grid.info.size, (std::array<std::uint64_t, 3>{3, 2, 1}));
  EXPECT_EQ(grid.info.origin, (std::array<double, 3>{105, 215, 0}));
  EXPECT_EQ(grid.info.step[0], (std::array<double, 3>{10, 0, 0}));
  EXPECT_EQ(grid.info.step[1], (std::array<double, 3>{0, -10, 0}));
  EXPECT_FALSE(grid.info.nodata);

  grid = read_grid(write_file("a.txt",
                              "NROWS 2\r\nNCOLS 3\r\nXLLCENTER 100\r\nYLLCENTER 200\r\nDX 10\r\nDY 5\r\n"
                              "NODATA_value -9999\r\n\r\n0 1 2 3 4 -9999"));
  EXPECT_EQ(grid.info.origin, (std::array<double, 3>{100, 205, 0}));
  EXPECT_EQ(grid.info.step[1], (std::array<double, 3>{0, -5, 0}));
  EXPECT_EQ(grid.info.nodata, -9999.0);
  EXPECT_EQ(grid.values.back(), -9999);
}

TEST(EsriGrid, NanCanBeAHeightAndNodata) {
  const Grid grid = read_grid(write_file("a.asc", kHead + "nodata_value nan\nnan 1 2\n3 4 5\n"));
  EXPECT_TRUE(std::isnan(grid.values[0]));
  ASSERT_TRUE(grid.info.nodata);
  EXPECT_TRUE(std::isnan(*grid.info.nodata));
}

TEST(EsriGrid, PlacesOfVertices) {
  const auto reader = open_grid(write_file("a.asc", kHead + "NODATA_value -1\n0 1 2\n3 44  5\n"));
  EXPECT_EQ(reader->place_of(0).position, "7:1");
  EXPECT_EQ(reader->place_of(5).position, "8:7");
}

// A decimal comma is not a blank.
TEST(EsriGrid, DecimalCommasAreRefused) {
  const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  try {
    read_grid(write_file("comma.asc", head + "12 345,5\n7 9\n"));
    ADD_FAILURE() << "read";
  } catch (const Error& error) {
    EXPECT_NE(error.message().find("\"345,5\" is not a number"), std::string::npos) << error.what();
    EXPECT_NE(error.hint().find("decimal points"), std::string::npos) << error.hint();
    EXPECT_EQ(error.position(), "6:4");
  }
}

TEST(EsriGrid, BadFilesAreRefused) {
  const auto error = [](const std::string& text) { return error_of(write_file("bad.asc", text)); };
  EXPECT_EQ(error(kHead + "0 1 2\n3 4    \n"), "bad.asc:8:1: the file ends after 5 of 6 values");
  EXPECT_EQ(error(kHead + "0 1 2\n3 4 x\n"), "bad.asc:7:5: \"x\" is not a number (a value should be here)");
  EXPECT_EQ(error("ncols 3\nnrows 2\n0 1 2\n"), "bad.asc:3:1: the header has no cellsize");
  EXPECT_EQ(error("ncols 3\ncellsize 1\n0 1 2\n"), "bad.asc:3:1: the header has no ncols or no nrows");
  EXPECT_EQ(error("ncols 3\nnrows two\n"), "bad.asc:2:7: \"two\" is not an integer (number of rows)");
  EXPECT_EQ(error("ncols 3\ncellsize 0\n"), "bad.asc:2:10: the size of a cell is not positive");
  EXPECT_EQ(error("ncols 3\nheight 0\n"), "bad.asc:2:1: a header has no field \"height\"");
  EXPECT_EQ(error("Dear all\nthis is no grid\n"), "bad.asc:1:1: a header has no field \"Dear\"");
  EXPECT_EQ(
      error("ncols 1000000\nnrows 1000000\ncellsize 1\n0 0 0\n"),
      "bad.asc:39: the header announces 1,000,000,000,000 values (at least 1,999,999,999,999 bytes), but the file "
      "holds 6 bytes of data");
}

}  // namespace
}  // namespace reeb::io::testing
