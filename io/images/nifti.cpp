#include "io/images/nifti.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "io/file/file_name.h"
#include "io/mesh/scalar_bytes.h"
#include "io/text/hints.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kHeaderBytes = 348;

// Offsets of the fields that are used.
constexpr std::size_t kDim = 40, kDatatype = 70, kPixdim = 76, kVoxOffset = 108, kSlope = 112, kIntercept = 116,
                      kQformCode = 252, kSformCode = 254, kQuaternion = 256, kQoffset = 268, kSrow = 280, kMagic = 344;

struct Datatype {
  int code;
  ScalarType type;
  unsigned components;
};
constexpr Datatype kDatatypes[] = {
    {2, ScalarType::kUint8, 1},      {4, ScalarType::kInt16, 1},    {8, ScalarType::kInt32, 1},
    {16, ScalarType::kFloat32, 1},   {32, ScalarType::kFloat32, 2}, {64, ScalarType::kFloat64, 1},
    {128, ScalarType::kUint8, 3},    {256, ScalarType::kInt8, 1},   {512, ScalarType::kUint16, 1},
    {768, ScalarType::kUint32, 1},   {1024, ScalarType::kInt64, 1}, {1280, ScalarType::kUint64, 1},
    {1792, ScalarType::kFloat64, 2}, {2304, ScalarType::kUint8, 4}};

class NiftiHeader {
 public:
  NiftiHeader(std::string_view head, const std::string& name) : head_(head), name_(name) {
    if (head.size() < kHeaderBytes) fail(head.size(), "the file ends inside its header");
    if (load_scalar<std::int32_t>(head.data(), false) != 348) big_endian_ = true;
    if (get<std::int32_t>(0) != 348) fail(0, "the header does not begin with its size, 348");
  }

  Image parse() const {
    Image image;
    image.big_endian = big_endian_;
    image.info.format = "NIfTI-1";
    take_type(image);
    take_size(image.info);
    take_scale(image);
    take_data_place(image);
    take_position(image.info);
    return image;
  }

 private:
  template <class T>
  T get(std::size_t offset) const {
    return load_scalar<T>(head_.data() + offset, big_endian_);
  }
  double real(std::size_t offset) const { return static_cast<double>(get<float>(offset)); }

  [[noreturn]] void fail(std::size_t offset, const std::string& what,
                         const std::string& hint = kCutOrDamagedHint) const {
    throw Error(ErrorKind::kBadInput, what, hint).at(name_, std::to_string(offset));
  }

  void take_type(Image& image) const {
    const int code = get<std::int16_t>(kDatatype);
    const auto* const found = std::ranges::find(kDatatypes, code, &Datatype::code);
    if (found == std::end(kDatatypes))
      fail(kDatatype, "values of NIfTI type " + std::to_string(code) + " are not read",
           "integers of 1, 2, 4 and 8 bytes, float, double, complex and RGB images are read");
    image.type = found->type;
    image.info.components = found->components;
  }

  void take_size(GridInfo& info) const {
    const int dimensions = get<std::int16_t>(kDim);
    if (dimensions < 1 || dimensions > 7) fail(kDim, "an image has 1 to 7 dimensions");
    std::vector<std::uint64_t> sizes;
    for (int k = 1; k <= dimensions; ++k) {
      const std::size_t at = kDim + 2 * static_cast<std::size_t>(k);
      const int size = get<std::int16_t>(at);
      if (size <= 0) fail(at, "an axis of the image has size " + std::to_string(size));
      if (k <= 3)
        sizes.push_back(static_cast<std::uint64_t>(size));
      else if (size != 1)
        fail(at,
             k == 4 ? "the image has " + count_of(static_cast<std::uint64_t>(size), "time step")
                    : "the image has " + std::to_string(size) + " values in dimension " + std::to_string(k),
             "write one of them into a file of its own, for example with fslroi or nibabel");
    }
    set_size(info, sizes);
  }

  void take_scale(Image& image) const {
    image.slope = real(kSlope);
    image.intercept = real(kIntercept);
    const bool colours = image.type == ScalarType::kUint8 && image.info.components > 1;
    image.scaled = image.slope != 0 && std::isfinite(image.slope) && std::isfinite(image.intercept) && !colours &&
                   (image.slope != 1 || image.intercept != 0);
    if (!image.scaled) image.slope = 1, image.intercept = 0;
  }

  void take_data_place(Image& image) const {
    const bool pair = head_.substr(kMagic).starts_with("ni1");
    const double offset = real(kVoxOffset);
    const double least = pair ? 0 : static_cast<double>(kHeaderBytes);
    if (offset == 0 && !pair)
      image.offset = kHeaderBytes + 4;
    else if (offset >= least && offset < 1e15)
      image.offset = static_cast<std::uint64_t>(offset);
    else
      fail(kVoxOffset, "the data cannot begin where the header says");
    if (!pair) return;
    std::filesystem::path file = std::filesystem::path(content_name(name_)).filename();
    image.data_file = file.replace_extension(".img").string();
  }

  void take_position(GridInfo& info) const {
    if (get<std::int16_t>(kSformCode) > 0)
      take_sform(info);
    else if (get<std::int16_t>(kQformCode) > 0)
      take_qform(info);
    else
      for (unsigned k = 0; k < 3; ++k) info.step[k][k] = pixdim(k);
    bool in_plane = info.origin[2] == 0;
    for (unsigned k = 0; k < 2; ++k) in_plane = in_plane && info.step[k][2] == 0;
    if (info.axes == 2 && !in_plane) info.axes = 3;
  }

  void take_sform(GridInfo& info) const {
    for (unsigned c = 0; c < 3; ++c) {
      const std::size_t row = kSrow + std::size_t{16} * c;
      for (unsigned k = 0; k < 3; ++k) info.step[k][c] = real(row + std::size_t{4} * k);
      info.origin[c] = real(row + 12);
    }
  }

  // The rotation of a unit quaternion, whose first number is not stored.
  void take_qform(GridInfo& info) const {
    double b = real(kQuaternion), c = real(kQuaternion + 4), d = real(kQuaternion + 8), a = 0;
    const double rest = 1 - (b * b + c * c + d * d);
    if (rest < 1e-7) {
      const double scale = 1 / std::sqrt(b * b + c * c + d * d);
      b *= scale, c *= scale, d *= scale;
    } else {
      a = std::sqrt(rest);
    }
    const double rotation[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                                   {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                                   {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}};
    const double handedness = real(kPixdim) < 0 ? -1 : 1;
    for (unsigned r = 0; r < 3; ++r) {
      for (unsigned k = 0; k < 3; ++k) info.step[k][r] = rotation[r][k] * pixdim(k) * (k == 2 ? handedness : 1);
      info.origin[r] = real(kQoffset + std::size_t{4} * r);
    }
  }

  double pixdim(unsigned axis) const {
    const double size = std::abs(real(kPixdim + 4 + std::size_t{4} * axis));
    return size == 0 ? 1 : size;
  }

  std::string_view head_;
  std::string name_;
  bool big_endian_ = false;
};

}  // namespace

bool is_nifti(std::string_view head) {
  using namespace std::string_view_literals;
  if (head.size() < kHeaderBytes) return false;
  const std::string_view magic = head.substr(kMagic, 4);
  return magic == "n+1\0"sv || magic == "ni1\0"sv;
}

Image parse_nifti(ContentSource& source) { return NiftiHeader(source.view(0), source.name()).parse(); }

}  // namespace reeb::io
