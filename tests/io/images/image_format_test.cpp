// Which files are images, and of which kind.
#include "io/formats/format_detection.h"
#include "io/formats/open_input.h"
#include "tests/io/images/nifti_files.h"
#include "tests/io/images/vti_files.h"

namespace reeb::io::testing {
namespace {

std::optional<ImageFormat> detected(const std::string& name, const std::string& bytes) {
  const std::string path = write_file(name, bytes);
  const auto source = open_content(path);
  const auto format = detect_image(*source, path);
  EXPECT_TRUE(!format || detect_format(*source, path) == MeshFormat::kUnknown) << name;
  return format;
}

TEST(ImageFormat, IsToldByTheContent) {
  const std::vector<std::pair<std::string, ImageFormat>> files = {
      {"NRRD0001\n", ImageFormat::kNrrd},
      {nifti({.dim = {2, 2, 2}}, "1234"), ImageFormat::kNifti},
      {nifti({.dim = {2, 2, 2}, .magic = "ni1"}, ""), ImageFormat::kNifti},
      {"ObjectType = Image\nNDims = 3\n", ImageFormat::kMetaImage},
      {"NDims=3\n", ImageFormat::kMetaImage},
      {"\x93NUMPY\1", ImageFormat::kNumpy},
      {vti_file("WholeExtent=\"0 0 0 0 0 0\"", {}), ImageFormat::kVti},
      {"\xEF\xBB\xBF<VTKFile byte_order='x' type='ImageData'>", ImageFormat::kVti},
      {"NCOLS 3\nNROWS 2\n", ImageFormat::kEsriGrid}};
  for (const auto& [bytes, format] : files) {
    EXPECT_EQ(detected("file", bytes), format) << bytes;
    EXPECT_EQ(detected("file.gz", gzip_packed(bytes)), format) << bytes;
    EXPECT_EQ(detected("file.raw", bytes), format) << bytes;
  }
}

TEST(ImageFormat, ElseByTheName) {
  const std::string values(100, '\x77');
  EXPECT_EQ(detected("a.raw", values), ImageFormat::kRaw);
  EXPECT_EQ(detected("a.RAW.gz", gzip_packed(values)), ImageFormat::kRaw);
  EXPECT_EQ(detected("a.asc", "xllcorner 3\n"), ImageFormat::kEsriGrid);
  EXPECT_EQ(detected("a.bin", values), std::nullopt);
  EXPECT_EQ(detected("a.raw", "OFF\n0 0 0\n"), std::nullopt);
  EXPECT_EQ(detected("a.vti", "<VTKFile type=\"PolyData\">"), std::nullopt);
  EXPECT_EQ(detected("a.ply", "ply\nformat ascii 1.0\nend_header\n"), std::nullopt);
}

TEST(ImageFormat, HasAName) {
  for (const char* name : {"nrrd", "nifti", "mha", "npy", "vti", "asc", "raw"})
    EXPECT_TRUE(image_format_named(name)) << name;
  EXPECT_FALSE(image_format_named("NRRD"));
  EXPECT_FALSE(image_format_named(""));
  EXPECT_EQ(image_name(ImageFormat::kNumpy), "a NumPy array");
}

TEST(ImageFormat, AnImageIsNoMesh) {
  const std::string path = write_file("a.ply", "NRRD0004\n");
  try {
    open_mesh(open_content(path), path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message(), "this is an NRRD image, a grid of values, not a mesh");
  }
}

}  // namespace
}  // namespace reeb::io::testing
