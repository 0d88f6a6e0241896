#include "tests/fuzz/image_targets.h"

#include <array>
#include <bit>
#include <cmath>
#include <memory>

#include "io/formats/open_grid.h"
#include "tests/fuzz/legality.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/memory_source.h"
#include "tests/io/images/nifti_files.h"
#include "tests/io/images/vti_files.h"

namespace reeb::test {
namespace {

using namespace reeb::io;

constexpr std::uint64_t kMostValues = 100'000;  // few bytes can stand for very many

struct Values {
  std::vector<std::uint64_t> bits;
  bool whole = false, good = false;
  friend bool operator==(const Values&, const Values&) = default;
};

void check_info(const GridInfo& info) {
  expect(info.axes == 2 || info.axes == 3, "a vertex has 2 or 3 coordinates");
  expect(info.axes == 3 || info.size[2] == 1, "two axes have no depth");
  expect(info.components > 0, "a vertex has a value");
  std::uint64_t room = (std::uint64_t{1} << 56) / info.components;
  for (unsigned k = 0; k < 3; ++k) {
    expect(info.size[k] > 0 && info.size[k] <= room, "no axis is empty, and all vertices can be counted");
    room /= info.size[k];
    expect(std::isfinite(info.origin[k]), "the origin is finite");
    for (const double step : info.step[k]) expect(std::isfinite(step), "steps are finite");
  }
}

Values read_values(GridReader& reader, std::size_t vertices) {
  const GridInfo& info = reader.info();
  Values all;
  std::vector<double> part(vertices * info.components);
  std::uint64_t count = 0;
  while (all.bits.size() < kMostValues) {
    const std::size_t got = reader.read(part);
    expect(got <= vertices, "no more is delivered than asked for");
    for (std::size_t i = 0; i < got * info.components; ++i) all.bits.push_back(std::bit_cast<std::uint64_t>(part[i]));
    count += got;
    expect(got == vertices || count == info.vertex_count(), "there are as many vertices as announced");
    if (got < vertices) break;
  }
  all.whole = count == info.vertex_count();
  if (all.bits.size() > kMostValues) all.bits.resize(kMostValues);
  (void)reader.warnings();
  if (count != 0) (void)reader.place_of(count - 1);
  return all;
}

// Reads as a file, the same again, and as a pipe.
template <ImageFormat format>
bool run_image(const std::string& bytes) {
  if (bytes.empty()) return false;
  const MemoryFile file(bytes);
  const GridOptions options{format, {}};
  const std::size_t step = 1 + bytes.size() % 37;
  Values first, pipe;
  const std::string error = error_of([&] {
    const auto reader = open_grid(file.path(), options);
    check_info(reader->info());
    first = read_values(*reader, step);
    reader->rewind();
    const Values again = read_values(*reader, 2 * step);
    expect(again == first, "an image is the same after rewinding");
  });
  const bool good = error.empty();
  // A content that is packed as a whole is unpacked in one case only.
  if (bytes.starts_with("\x1F\x8B") || bytes.starts_with("\x28\xB5\x2F\xFD")) return good;
  const std::string pipe_error = error_of([&] {
    const Input input(file.path());
    const auto reader = open_grid(input, std::make_unique<MemorySource>(bytes, MemorySource::Kind::kPipe), options);
    pipe = read_values(*reader, step);
  });
  const bool needs_size = pipe_error.starts_with("the header says that the data are the last bytes");
  expect(pipe_error.empty() || !good || needs_size, "a pipe is read if the file is");
  if (good && pipe_error.empty()) expect(pipe == first, "file and pipe hold the same image");
  return good;
}

using testing::binary;

const std::vector<std::int16_t> kStored = {0, 1, -2, 300, 4, 5};

std::vector<std::string> nrrd_files() {
  const std::string head = "NRRD0005\n# comment\nkey:=value\ndimension: 3\nsizes: 3 2 1\ntype: short\nendian: big\n";
  const std::string bytes = binary(kStored, true);
  return {
      head + "encoding: raw\n\n" + bytes,
      head + "encoding: raw\nbyte skip: -1\nspacings: 1 2 3\naxis mins: 1 2 3\ncenters: cell node cell\n\n" + bytes,
      head + "encoding: gzip\nline skip: 1\n\nline\n" + testing::gzip_packed(bytes),
      head + "encoding: hex\nspace dimension: 3\nspace directions: (1,0,0) (0,1,0) none\n\n" +
          "0000000100020003"
          "0004 0005\n",
      head + "encoding: ascii\nspace origin: (1,2,3)\n\n0 1, 2\nnan 1e99 5\n",
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nkinds: vector domain domain\nencoding: raw\n\n123456789012",
      head + "encoding: raw\ndata file: nothing.raw\n\n"};
}

std::vector<std::string> nifti_images() {
  const std::string bytes = binary(kStored);
  return {testing::nifti({.dim = {3, 3, 2, 1}, .datatype = 4}, bytes),
          testing::nifti({.dim = {2, 3, 2}, .datatype = 4, .big_endian = true, .sform = true}, bytes),
          testing::nifti({.dim = {4, 3, 1, 1, 1}, .datatype = 32, .qform = true, .slope = 2}, bytes + bytes),
          testing::nifti({.dim = {2, 2, 2}, .datatype = 128, .magic = "ni1"}, bytes)};
}

std::vector<std::string> meta_images() {
  const std::string head = "ObjectType = Image\nNDims = 3\nDimSize = 3 2 1\nElementType = MET_SHORT\n";
  const std::string bytes = binary(kStored);
  return {head + "ElementDataFile = LOCAL\n" + bytes,
          head + "HeaderSize = -1\nBinaryDataByteOrderMSB = True\nElementDataFile = LOCAL\n" + bytes,
          head + "CompressedData = True\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nElementDataFile = LOCAL\n" +
              testing::zlib_packed(bytes),
          head + "BinaryData = False\nElementSpacing = 1 2 3\nOffset = 1 2 3\nElementDataFile = LOCAL\n0 1 2 3 4 5\n",
          head + "ElementNumberOfChannels = 2\nElementDataFile = LOCAL\n" + bytes + bytes};
}

std::vector<std::string> numpy_arrays() {
  const std::string bytes = binary(kStored);
  std::vector<std::string> files;
  for (const char* text : {"{'descr': '<i2', 'fortran_order': False, 'shape': (2, 3), }\n",
                           "{'descr': '>i2', 'fortran_order': True, 'shape': (2L, 3L, 1L), }\n"}) {
    const auto length = static_cast<char>(std::string(text).size());
    files.push_back(std::string("\x93NUMPY\1\0", 8) + length + std::string(1, '\0') + text + bytes);
    files.push_back(std::string("\x93NUMPY\2\0", 8) + length + std::string(3, '\0') + text + bytes);
  }
  return files;
}

std::vector<std::string> vti_images() {
  std::vector<std::string> files;
  const std::string image = "WholeExtent=\"-1 1 0 1 5 5\" Origin=\"1 2 3\" Spacing=\"1 2 3\"";
  for (const bool big : {false, true}) {
    const std::string bytes = binary(kStored, big);
    const std::vector<testing::VtiArray> arrays = {{"a", "Int16", 1, bytes, "0 1 2\n3 4 5"},
                                                   {"b", "Int16", 1, bytes, "0 1 2\n3 4 5"}};
    for (const char* packing : {"", "ZLib", "LZ4"})
      for (const char* format : {"ascii", "binary", "appended"})
        files.push_back(testing::vti_file(image, arrays, {format, false, packing, big, big}, "b"));
    files.push_back(testing::vti_file(image, arrays, {"appended", true, "ZLib", !big, big}));
  }
  return files;
}

std::vector<std::string> esri_grids() {
  const std::string head = "ncols 3\nnrows 2\nxllcorner 1\nyllcenter 2\ncellsize 3\n";
  return {head + "0 1 2\n3 4 5\n", head + "NODATA_value -9999\n0 nan -9999\n3 4 5",
          "NROWS 1\r\nNCOLS 1\r\nDX 1\r\nDY 2\r\n7\r\n"};
}

constexpr std::string_view kNrrdWords[] = {
    "sizes: 9 9",     "kinds: vector domain", "encoding: ",   "gzip", "byte skip: ", "line skip: 1",
    "centers: ",      "space: RAST",          "dimension: 2", "none", "(1,2,3)",     "data file: a",
    "endian: little", "type: double",         "nan",          "uchar"};
constexpr std::string_view kMetaWords[] = {
    "NDims = 2",  "HeaderSize = ", "ElementNumberOfChannels = ", "True", "\nNDims = 3\n", "\nElementSpacing = 1 1\n",
    "MET_DOUBLE", "LIST",          "ElementDataFile = ",         "LOCAL"};
constexpr std::string_view kNumpyWords[] = {"'descr': ", "'shape': ", "'fortran_order': ", "True", "False", "(", ")",
                                            "<f8",       "|u1"};
constexpr std::string_view kVtiWords[] = {"WholeExtent=\"",
                                          "Extent=\"",
                                          "format=\"ascii\"",
                                          "format=\"binary\"",
                                          "<Piece ",
                                          "</Piece>",
                                          "<PointData>",
                                          "<DataArray ",
                                          "</DataArray>",
                                          "header_type=\"UInt64\"",
                                          "compressor=\"vtkLZ4DataCompressor\"",
                                          "encoding=\"base64\"",
                                          "<!--",
                                          "-->",
                                          "<![CDATA[",
                                          "&amp;",
                                          "&#65;",
                                          "<!DOCTYPE a [<!ENTITY b \"c\">]>",
                                          "_"};
constexpr std::string_view kEsriWords[] = {"ncols ",     "nrows ",        "cellsize ", "dx ",
                                           "xllcenter ", "NODATA_value ", "nan",       "inf"};

const std::array<FuzzTarget, 6> kTargets = {{
    {"nrrd", run_image<ImageFormat::kNrrd>, nrrd_files, kNrrdWords, nullptr},
    {"nifti", run_image<ImageFormat::kNifti>, nifti_images, {}, nullptr},
    {"meta-image", run_image<ImageFormat::kMetaImage>, meta_images, kMetaWords, nullptr},
    {"npy", run_image<ImageFormat::kNumpy>, numpy_arrays, kNumpyWords, nullptr},
    {"vti", run_image<ImageFormat::kVti>, vti_images, kVtiWords, nullptr},
    {"asc", run_image<ImageFormat::kEsriGrid>, esri_grids, kEsriWords, nullptr},
}};

}  // namespace

std::span<const FuzzTarget> image_fuzz_targets() { return kTargets; }

}  // namespace reeb::test
