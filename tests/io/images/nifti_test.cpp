// NIfTI-1 headers and data.
#include "tests/io/images/nifti_files.h"

#include <cmath>

namespace reeb::io::testing {
namespace {

using Values = std::vector<double>;
using Vectors = std::array<std::array<double, 3>, 3>;

Grid read(const NiftiHead& head, const std::string& data) { return read_grid(write_file("a.nii", nifti(head, data))); }

template <class T>
void expect_type(std::int16_t code) {
  const std::vector<T> stored = {
      0, 1, static_cast<T>(-2), std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest(), 5};
  for (const bool big : {false, true}) {
    SCOPED_TRACE(code);
    const NiftiHead head{.dim = {3, 3, 2, 1}, .datatype = code, .big_endian = big};
    EXPECT_EQ(read(head, binary(stored, big)).values, Values(stored.begin(), stored.end()));
  }
}

TEST(Nifti, EveryTypeInBothByteOrders) {
  expect_type<std::uint8_t>(2);
  expect_type<std::int16_t>(4);
  expect_type<std::int32_t>(8);
  expect_type<float>(16);
  expect_type<double>(64);
  expect_type<std::int8_t>(256);
  expect_type<std::uint16_t>(512);
  expect_type<std::uint32_t>(768);
  expect_type<std::int64_t>(1024);
  expect_type<std::uint64_t>(1280);
}

TEST(Nifti, ScalesValues) {
  const std::string data = binary<std::int16_t>({-2, 0, 3, 4});
  NiftiHead head{.dim = {2, 2, 2}, .datatype = 4};
  const auto values = [&](float slope, float intercept) {
    head.slope = slope;
    head.intercept = intercept;
    return read(head, data).values;
  };
  EXPECT_EQ(values(0.5F, 10), (Values{9, 10, 11.5, 12}));
  EXPECT_EQ(values(0, 10), (Values{-2, 0, 3, 4}));  // no scale
  EXPECT_EQ(values(1, 1), (Values{-1, 1, 4, 5}));
  EXPECT_EQ(values(NAN, 1), (Values{-2, 0, 3, 4}));
}

TEST(Nifti, Positions) {
  const std::string data(24, '\1');
  NiftiHead head{.dim = {3, 2, 3, 4}};
  GridInfo info = read(head, data).info;
  EXPECT_EQ(info.format, "NIfTI-1");
  EXPECT_EQ(info.origin, (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(info.step, (Vectors{{{0.5, 0, 0}, {0, 2, 0}, {0, 0, 3}}}));

  // b = c = d = 1/2 turns x to y, y to z and z to x; then a = 1/2, too.
  head.qform = true;
  head.quaternion = {0.5F, 0.5F, 0.5F, 1, 2, 3};
  info = read(head, data).info;
  EXPECT_EQ(info.origin, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(info.step, (Vectors{{{0, 0.5, 0}, {0, 0, 2}, {3, 0, 0}}}));
  head.pixdim[0] = -1;  // left-handed
  EXPECT_EQ(read(head, data).info.step[2], (std::array<double, 3>{-3, 0, 0}));
  head.quaternion = {1, 0, 0, 0, 0, 0};  // half a turn about x
  head.pixdim[0] = 1;
  EXPECT_EQ(read(head, data).info.step, (Vectors{{{0.5, 0, 0}, {0, -2, 0}, {0, 0, -3}}}));

  head.sform = true;
  head.srow = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  info = read(head, data).info;
  EXPECT_EQ(info.origin, (std::array<double, 3>{4, 8, 12}));
  EXPECT_EQ(info.step, (Vectors{{{1, 5, 9}, {2, 6, 10}, {3, 7, 11}}}));
}

TEST(Nifti, Dimensions) {
  const std::string data(24, '\1');
  const auto info_of = [&](std::vector<std::int16_t> dim) { return read({.dim = std::move(dim)}, data).info; };
  EXPECT_EQ(info_of({2, 4, 6}).axes, 2u);
  EXPECT_EQ(info_of({3, 4, 6, 1}).axes, 3u);
  EXPECT_EQ(info_of({4, 4, 3, 2, 1}).axes, 3u);
  EXPECT_EQ(info_of({7, 4, 3, 2, 1, 1, 1, 1}).size, (std::array<std::uint64_t, 3>{4, 3, 2}));
  // A slice that is not in the plane z = 0 has three coordinates.
  EXPECT_EQ(read({.dim = {2, 4, 6}, .sform = true}, data).info.axes, 3u);
}

TEST(Nifti, ComponentsThatAreNextToEachOther) {
  Grid grid = read({.dim = {2, 2, 1}, .datatype = 128, .slope = 2}, "\1\2\3\4\5\6");
  EXPECT_EQ(grid.info.components, 3u);
  EXPECT_EQ(grid.values, (Values{1, 2, 3, 4, 5, 6}));
  grid = read({.dim = {2, 2, 1}, .datatype = 32}, binary<float>({1, 2, 3, 4}));
  EXPECT_EQ(grid.info.components, 2u);
}

TEST(Nifti, HeaderAndDataInTwoFiles) {
  const NiftiHead head{.dim = {2, 2, 2}, .vox_offset = 0, .magic = "ni1"};
  write_file("pair.img", "\1\2\3\4");
  EXPECT_EQ(read_grid(write_file("pair.hdr", nifti(head, ""))).values, (Values{1, 2, 3, 4}));
  std::filesystem::remove(scratch_folder() / "pair.img");
  write_file("pair.img.gz", gzip_packed("\1\2\3\4"));
  EXPECT_EQ(read_grid(write_file("pair.hdr.gz", gzip_packed(nifti(head, "")))).values, (Values{1, 2, 3, 4}));
  std::filesystem::remove(scratch_folder() / "pair.img.gz");
  write_file("pair.img.zst", zstd_packed("\1\2\3\4"));
  EXPECT_EQ(read_grid(write_file("pair.hdr.zst", zstd_packed(nifti(head, "")))).values, (Values{1, 2, 3, 4}));
  write_file("pair.img", "\5\6\7\10");
  EXPECT_EQ(read_grid(write_file("pair.hdr.zst", zstd_packed(nifti(head, "")))).values, (Values{5, 6, 7, 8}));
  EXPECT_EQ(error_of(write_file("alone.hdr", nifti(head, ""))).substr(0, 10), "alone.img:");
}

TEST(Nifti, BadFilesAreRefused) {
  const std::string data(24, '\1');
  const auto error = [&](const NiftiHead& head) { return error_of(write_file("bad.nii", nifti(head, data))); };
  EXPECT_EQ(error({.dim = {3, 5, 5, 1}}),
            "bad.nii:352: the header announces 25 values (25 bytes), but the file holds 24 bytes of data");
  EXPECT_EQ(error({.dim = {3, 30000, 30000, 30000}, .datatype = 16}).substr(0, 60),
            "bad.nii:352: the header announces 27,000,000,000,000 values ");
  EXPECT_EQ(error({.dim = {0}}), "bad.nii:40: an image has 1 to 7 dimensions");
  EXPECT_EQ(error({.dim = {3, 1, 0, 1}}), "bad.nii:44: an axis of the image has size 0");
  EXPECT_EQ(error({.dim = {3, 1, -7, 1}}), "bad.nii:44: an axis of the image has size -7");
  EXPECT_EQ(error({.dim = {4, 2, 2, 2, 3}}), "bad.nii:48: the image has 3 time steps");
  EXPECT_EQ(error({.dim = {5, 2, 2, 2, 1, 3}}), "bad.nii:50: the image has 3 values in dimension 5");
  EXPECT_EQ(error({.dim = {1, 24}}), "bad.nii: the image has 1 axis");
  EXPECT_EQ(error({.dim = {2, 2, 2}, .datatype = 1536}), "bad.nii:70: values of NIfTI type 1536 are not read");
  EXPECT_EQ(error({.dim = {2, 2, 2}, .vox_offset = 4}), "bad.nii:108: the data cannot begin where the header says");
  EXPECT_EQ(error({.dim = {2, 2, 2}, .vox_offset = NAN}), "bad.nii:108: the data cannot begin where the header says");
  EXPECT_EQ(error({.dim = {2, 2, 2}, .vox_offset = 1e12F}).substr(0, 20), "bad.nii:999999995904");
  EXPECT_EQ(error({.dim = {2, 2, 2}, .sform = true, .srow = {INFINITY}}),
            "bad.nii: the header has an origin, a spacing or a scale that is not finite");
  const std::string packed = gzip_packed(nifti({.dim = {3, 30000, 30000, 30000}, .datatype = 16}, data));
  EXPECT_EQ(error_of(write_file("bad.nii.gz", packed)),
            "bad.nii.gz:376: the file ends after 6 of 27,000,000,000,000 values");
}

}  // namespace
}  // namespace reeb::io::testing
