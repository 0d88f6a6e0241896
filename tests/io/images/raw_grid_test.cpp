// Files without a header.
#include <sys/stat.h>

#include <thread>

#include "tests/io/images/image_files.h"

namespace reeb::io::testing {
namespace {

GridOptions raw(const std::string& grid, const std::string& type, const std::string& spacing = "",
                std::uint64_t skip = 0) {
  return {ImageFormat::kRaw, parse_raw_grid(grid, type, spacing, skip)};
}

template <class T>
void expect_type(const std::string& name) {
  const std::vector<T> stored = {
      0, 1, static_cast<T>(-2), std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest(), 5};
  const std::vector<double> expected(stored.begin(), stored.end());
  const bool ordered = sizeof(T) > 1;
  for (const bool big : {false, true}) {
    const std::string path = write_file("a.raw", "skipped" + binary(stored, big));
    const std::string type = name + (!ordered ? "" : big ? "be" : "le");
    const Grid grid = read_grid(path, raw("2x3", type, "", 7));
    EXPECT_EQ(grid.values, expected) << type;
    EXPECT_EQ(grid.info.format, "raw " + type);
  }
}

TEST(RawGrid, EveryTypeInBothByteOrders) {
  expect_type<std::int8_t>("i8");
  expect_type<std::uint8_t>("u8");
  expect_type<std::int16_t>("i16");
  expect_type<std::uint16_t>("u16");
  expect_type<std::int32_t>("i32");
  expect_type<std::uint32_t>("u32");
  expect_type<std::int64_t>("i64");
  expect_type<std::uint64_t>("u64");
  expect_type<float>("f32");
  expect_type<double>("f64");
}

TEST(RawGrid, SizeAndSpacing) {
  GridInfo info = read_grid(write_file("a.raw", std::string(24, '1')), raw("2x3x4", "u8", "0.5,1,-2")).info;
  EXPECT_EQ(info.size, (std::array<std::uint64_t, 3>{2, 3, 4}));
  EXPECT_EQ(info.axes, 3u);
  EXPECT_EQ(info.step[2], (std::array<double, 3>{0, 0, -2}));
  info = read_grid(write_file("a.raw", std::string(24, '1')), raw("4x6", "u8")).info;
  EXPECT_EQ(info.axes, 2u);
  EXPECT_EQ(info.size, (std::array<std::uint64_t, 3>{4, 6, 1}));
}

TEST(RawGrid, TheFileHoldsTheGridAndNoMore) {
  const std::string path = write_file("a.raw", std::string(24, '1'));
  EXPECT_EQ(error_of(path, raw("5x5", "u8")),
            "a.raw:0: the grid has 25 values (25 bytes), but the file holds 24 bytes of data");
  EXPECT_EQ(error_of(path, raw("2x5", "u16le", "", 2)),
            "a.raw:22: the grid has 10 values (20 bytes), but the file holds 22 bytes");
  const std::string packed = write_file("a.raw.gz", gzip_packed(std::string(24, '1')));
  EXPECT_EQ(error_of(packed, raw("5x5", "u8")), "a.raw.gz:24: the file ends after 24 of 25 values");
  EXPECT_EQ(error_of(packed, raw("2x5", "u16le", "", 2)),
            "a.raw.gz:23: the file holds more than the 10 values of the grid");
  EXPECT_EQ(error_of(packed, raw("3x4", "u16be")), "");
}

TEST(RawGrid, WhatAUserWritesIsChecked) {
  const auto error = [](const std::string& grid, const std::string& type, const std::string& spacing = "") {
    try {
      parse_raw_grid(grid, type, spacing, 0);
    } catch (const Error& refused) {
      EXPECT_EQ(refused.kind(), ErrorKind::kUsage);
      return refused.message();
    }
    return std::string();
  };
  for (const char* grid : {"5", "5x", "x5", "5x5x5x5", "0x5", "-1x5", "5X5", "5x5 ", "99999999999999999999x2"})
    EXPECT_EQ(error(grid, "u8"), "--grid \"" + std::string(grid) + "\" is not the size of a grid");
  for (const char* type : {"u16", "u8le", "f16le", "float", "U8"})
    EXPECT_EQ(error("5x5", type), "--type \"" + std::string(type) + "\" is not a type of values");
  EXPECT_EQ(error("", "u8"), "--grid is missing: --type, --spacing and --skip are for raw images");
  EXPECT_EQ(error("", "", "1,1"), "--grid is missing: --type, --spacing and --skip are for raw images");
  EXPECT_EQ(error("5x5", ""), "--type is missing: --grid is for raw images");
  EXPECT_EQ(error("5x5", "u8", "1,x"), "--spacing \"1,x\" is not a list of numbers");
  EXPECT_EQ(error("5x5", "u8", "1,nan"), "--spacing \"1,nan\" is not a list of numbers");
  for (const std::string zero : {"0,1", "1,-0", "1,0.0"})
    EXPECT_EQ(error("5x5", "u8", zero),
              "--spacing \"" + zero + "\" has a zero, which gives all vertices of an axis the same place");
  EXPECT_EQ(error("5x5", "u8", "1,inf"), "--spacing \"1,inf\" is not a list of numbers");
  EXPECT_EQ(error("5x5", "u8", "1,1,1"), "--spacing \"1,1,1\" does not have one number for each axis of --grid 5x5");
}

TEST(RawGrid, ARawFileNeedsItsSize) {
  EXPECT_EQ(error_of(write_file("a.raw", "123")), "a.raw: a raw file does not say what it holds");
}

// A pipe is read once; a file can change.
TEST(RawGrid, APipeIsReadOnce) {
  const std::string path = (scratch_folder() / "pipe.raw").string();
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(path, std::ios::binary) << std::string(100'000, '1'); });
  const auto reader = open_grid(path, raw("1000x100", "u8"));
  reader->rewind();
  std::vector<double> values(100'000);
  EXPECT_EQ(reader->read(values), 100'000u);
  EXPECT_EQ(reader->read(values), 0u);
  EXPECT_THROW(reader->rewind(), Error);
  writer.join();
}

}  // namespace
}  // namespace reeb::io::testing
