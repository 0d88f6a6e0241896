// One volume in every format: the same values at the same places.
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "tests/io/images/nifti_files.h"
#include "tests/io/images/vti_files.h"

namespace reeb::io::testing {
namespace {

constexpr std::size_t kX = 4, kY = 3, kZ = 2;

std::vector<std::int16_t> volume() {
  std::vector<std::int16_t> values;
  for (std::size_t i = 0; i < kX * kY * kZ; ++i) values.push_back(static_cast<std::int16_t>(i * 997 % 101 - 50));
  return values;
}

void expect_volume(const Grid& grid, bool placed = true) {
  const auto stored = volume();
  EXPECT_EQ(grid.values, std::vector<double>(stored.begin(), stored.end()));
  EXPECT_EQ(grid.info.axes, 3u);
  EXPECT_EQ(grid.info.components, 1u);
  EXPECT_EQ(grid.info.size, (std::array<std::uint64_t, 3>{kX, kY, kZ}));
  if (!placed) return;
  EXPECT_EQ(grid.info.origin, (std::array<double, 3>{10, -20, 0.5}));
  EXPECT_EQ(grid.info.step, (std::array<std::array<double, 3>, 3>{{{0.5, 0, 0}, {0, 2, 0}, {0, 0, 3}}}));
}

TEST(SameVolume, InEveryFormat) {
  for (const bool big : {false, true}) {
    const std::string bytes = binary(volume(), big);
    const auto check = [&](const std::string& name, const std::string& file, bool placed = true) {
      SCOPED_TRACE(name);
      expect_volume(read_grid(write_file(name, file)), placed);
      expect_volume(read_grid(write_file(name + ".gz", gzip_packed(file))), placed);
    };
    check("v.nrrd", std::string("NRRD0005\ntype: short\ndimension: 3\nsizes: 4 3 2\nendian: ") +
                        (big ? "big" : "little") +
                        "\nencoding: raw\nspace directions: (0.5,0,0) (0,2,0) (0,0,3)\nspace: LPS\n"
                        "space origin: (10,-20,0.5)\n\n" +
                        bytes);
    check("v.nii", nifti({.dim = {3, 4, 3, 2}, .datatype = 4, .big_endian = big, .sform = true}, bytes));
    check("v.mha", std::string("ObjectType = Image\nNDims = 3\nBinaryDataByteOrderMSB = ") + (big ? "True" : "False") +
                       "\nElementSpacing = 0.5 2 3\nOffset = 10 -20 0.5\nDimSize = 4 3 2\nElementType = MET_SHORT\n"
                       "ElementDataFile = LOCAL\n" +
                       bytes);
    for (const char* packing : {"", "ZLib", "LZ4"})
      check("v.vti", vti_file("WholeExtent=\"1 4 0 2 0 1\" Origin=\"9.5 -20 0.5\" Spacing=\"0.5 2 3\"",
                              {{"a", "Int16", 1, bytes, ""}}, {.packing = packing, .big_endian = big}));
    const std::string dictionary =
        std::string("{'descr': '") + (big ? ">" : "<") + "i2', 'fortran_order': False, 'shape': (2, 3, 4), }\n";
    check("v.npy",
          "\x93NUMPY\x01" + std::string(1, '\0') + static_cast<char>(dictionary.size()) + std::string(1, '\0') +
              dictionary + bytes,
          false);
    write_file("v.raw", bytes);
    const GridOptions options{{}, parse_raw_grid("4x3x2", big ? "i16be" : "i16le", "0.5,2,3", 0)};
    expect_volume(read_grid((scratch_folder() / "v.raw").string(), options), false);
  }
}

// Debian's python3-numpy writes arrays of every kind.
TEST(SameVolume, WrittenByNumPy) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import numpy' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "python3-numpy is not installed";
  const std::string script = R"(
import numpy, sys
a = (numpy.arange(24) * 997 % 101 - 50).reshape(2, 3, 4)
for order in 'C', 'F':
    for t in '<i2', '>i2', '<i4', '>i4', '<i8', '>i8', '<f4', '>f4', '<f8', '>f8', 'i1':
        b = a if order == 'C' else a.transpose(2, 1, 0)
        c = numpy.array(b.astype(t), order=order)
        for version in (1, 0), (2, 0), (3, 0):
            name = '%s/np-%s-%s-%d.npy' % (sys.argv[1], order, t.replace('<', 'l').replace('>', 'b'), version[0])
            with open(name, 'wb') as f:
                numpy.lib.format.write_array(f, c, version=version)
)";
  write_file("write.py", script);
  const std::string folder = scratch_folder().string();
  ASSERT_EQ(std::system((python + " " + folder + "/write.py " + folder + " 2>/dev/null").c_str()), 0);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.path().filename().string().starts_with("np-")) continue;
    SCOPED_TRACE(entry.path().filename().string());
    expect_volume(read_grid(entry.path().string()), false);
    ++files;
  }
  EXPECT_EQ(files, 2 * 11 * 3);
}

}  // namespace
}  // namespace reeb::io::testing
