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

// Runs a script with a folder as its argument. Whether Debian's Python has the module that it needs.
bool run_python(const std::string& module, const std::string& script, const std::string& folder) {
  const std::string python = "/usr/bin/python3", quiet = " >/dev/null 2>&1";
  if (std::system((python + " -c 'import " + module + "'" + quiet).c_str()) != 0) return false;
  std::filesystem::create_directories(folder);
  const std::string path = write_file("write.py", script);
  EXPECT_EQ(std::system((python + " " + path + " " + folder + quiet).c_str()), 0);
  return true;
}

template <class Check>
int for_each_file(const std::string& folder, const Check& check) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".img") continue;
    SCOPED_TRACE(entry.path().filename().string());
    check(entry.path().string());
    ++files;
  }
  return files;
}

TEST(SameVolume, WrittenByNumPy) {
  const std::string folder = (scratch_folder() / "numpy").string();
  if (!run_python("numpy", R"(
import numpy, sys
a = (numpy.arange(24) * 997 % 101 - 50).reshape(2, 3, 4)
for order in 'C', 'F':
    for t in '<i2', '>i2', '<i4', '>i4', '<i8', '>i8', '<f4', '>f4', '<f8', '>f8', 'i1':
        b = a if order == 'C' else a.transpose(2, 1, 0)
        c = numpy.array(b.astype(t), order=order)
        for version in (1, 0), (2, 0), (3, 0):
            name = '%s/%s-%s-%d.npy' % (sys.argv[1], order, t.replace('<', 'l').replace('>', 'b'), version[0])
            with open(name, 'wb') as f:
                numpy.lib.format.write_array(f, c, version=version)
)",
                  folder))
    GTEST_SKIP() << "python3-numpy is not installed";
  EXPECT_EQ(for_each_file(folder, [](const std::string& path) { expect_volume(read_grid(path), false); }), 2 * 11 * 3);
}

TEST(SameVolume, WrittenByNiBabel) {
  const std::string folder = (scratch_folder() / "nibabel").string();
  if (!run_python("nibabel", R"(
import nibabel, numpy, sys
a = (numpy.arange(24) * 997 % 101 - 50).reshape(2, 3, 4).transpose(2, 1, 0)
affine = numpy.array([[0.5, 0, 0, 10], [0, 2, 0, -20], [0, 0, 3, 0.5], [0, 0, 0, 1]])
for t in 'i1', 'i2', 'i4', 'i8', 'f4', 'f8':
    for end in '<', '>':
        header = nibabel.Nifti1Header(endianness=end)
        header.set_data_dtype(numpy.dtype(t).newbyteorder(end))
        for codes in (1, 0), (0, 1):
            image = nibabel.Nifti1Image(a.astype(t), affine, header)
            image.set_sform(affine, codes[0])
            image.set_qform(affine, codes[1])
            name = '%s/%s-%d-%d' % (sys.argv[1], t, end == '>', codes[0])
            nibabel.save(image, name + '.nii')
            nibabel.save(image, name + '.nii.gz')
pair = nibabel.Nifti1Pair(a.astype('f4'), affine)
nibabel.save(pair, sys.argv[1] + '/pair.hdr')
)",
                  folder))
    GTEST_SKIP() << "not here: python3-nibabel is not installed";
  EXPECT_EQ(for_each_file(folder, [](const std::string& path) { expect_volume(read_grid(path)); }), 6 * 2 * 2 * 2 + 1);
}

TEST(SameVolume, WrittenByVtk) {
  const std::string folder = (scratch_folder() / "vtk").string();
  if (!run_python("vtkmodules.vtkIOXML", R"(
import sys
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkShortArray
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from vtkmodules.vtkIOImage import vtkMetaImageWriter
image = vtkImageData()
image.SetExtent(1, 4, 0, 2, 0, 1)
image.SetOrigin(9.5, -20, 0.5)
image.SetSpacing(0.5, 2, 3)
other, values = vtkFloatArray(), vtkShortArray()
other.SetName('other')
values.SetName('values')
for i in range(24):
    other.InsertNextValue(-i)
    values.InsertNextValue(i * 997 % 101 - 50)
image.GetPointData().AddArray(other)
image.GetPointData().SetScalars(values)
writer = vtkXMLImageDataWriter()
writer.SetInputData(image)
def write(name):
    for big in False, True:
        for wide in False, True:
            for packing in 'None', 'ZLib', 'LZ4':
                (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
                (writer.SetHeaderTypeToUInt64 if wide else writer.SetHeaderTypeToUInt32)()
                getattr(writer, 'SetCompressorTypeTo' + packing)()
                writer.SetBlockSize(16)
                writer.SetFileName('%s/%s-%d-%d-%s.vti' % (sys.argv[1], name, big, wide, packing))
                assert writer.Write()
writer.SetDataModeToAscii()
write('ascii')
writer.SetDataModeToBinary()
write('binary')
writer.SetDataModeToAppended()
writer.EncodeAppendedDataOff()
write('raw')
writer.EncodeAppendedDataOn()
write('base64')
)",
                  folder))
    GTEST_SKIP() << "not here: python3-vtk9 is not installed";
  EXPECT_EQ(for_each_file(folder, [](const std::string& path) { expect_volume(read_grid(path)); }), 4 * 2 * 2 * 3);
}

}  // namespace
}  // namespace reeb::io::testing
