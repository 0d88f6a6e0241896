#include "io/images/meta_image.h"

#include <optional>

#include "io/images/header_text.h"
#include "io/images/voxel_type.h"
#include "io/text/hints.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// MET_LONG has 4 bytes wherever it was written.
constexpr TypeName kMetaTypes[] = {
    {"met_char", ScalarType::kInt8},         {"met_uchar", ScalarType::kUint8},   {"met_short", ScalarType::kInt16},
    {"met_ushort", ScalarType::kUint16},     {"met_int", ScalarType::kInt32},     {"met_uint", ScalarType::kUint32},
    {"met_long", ScalarType::kInt32},        {"met_ulong", ScalarType::kUint32},  {"met_long_long", ScalarType::kInt64},
    {"met_ulong_long", ScalarType::kUint64}, {"met_float", ScalarType::kFloat32}, {"met_double", ScalarType::kFloat64}};

class MetaHeader {
 public:
  MetaHeader(std::string_view head, const std::string& name) : text_(head, name), name_(name) {}

  Image parse() {
    while (!ended_) {
      if (!text_.next_line()) fail_whole("the header has no ElementDataFile, which must be its last line");
      if (!without_blanks(text_.line()).empty()) field();
    }
    if (!type_) fail_whole("the header has no ElementType");
    if (sizes_.empty()) fail_whole("the header has no DimSize");
    image_.type = *type_;
    image_.info.format = std::string("MetaImage") + (compressed_ ? " zlib" : "");
    if (channels_ == 0 || channels_ > 4096)
      fail_whole("a vertex has " + count_of(channels_, "component") + "; 1 to 4,096 are read");
    image_.info.components = static_cast<unsigned>(channels_);
    set_size(image_.info, sizes_);
    image_.packing = !binary_ ? Packing::kText : compressed_ ? Packing::kZlib : Packing::kPlain;
    take_position();
    take_header_size();
    // Within this file, HeaderSize is the place of the data whatever packs them.
    if (image_.data_file.empty() && header_size_ > 0) {
      image_.offset = static_cast<std::uint64_t>(header_size_);
      image_.skip_bytes = 0;
    } else if (image_.data_file.empty()) {
      image_.offset = text_.offset();
      image_.text_line = text_.line_number() + 1;
    }
    return std::move(image_);
  }

 private:
  [[noreturn]] void fail_whole(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, kHeaderHint).at(name_, std::to_string(text_.line_number()) + ":1");
  }

  void field() {
    const std::size_t equal = text_.line().find('=');
    if (equal == std::string_view::npos) text_.fail("this line is not a field (\"Name = value\")", kHeaderHint);
    const std::string name = lower_case(without_blanks(text_.line().substr(0, equal)));
    const std::string_view value = without_blanks(text_.line().substr(equal + 1));
    if (name == "objecttype") {
      if (lower_case(value) != "image")
        text_.fail(value, "this is not an image but " + in_quotes(value), "name an image");
    } else if (name == "ndims") {
      // The lists of numbers are as long as the first one says.
      if (dimensions_ != 0) text_.fail(value, "NDims is given twice", kHeaderHint);
      dimensions_ = text_.count(value, "number of dimensions");
      if (dimensions_ != 2 && dimensions_ != 3)
        text_.fail(value, "the image has " + count_of(dimensions_, "axis"), "images with 2 and 3 axes are read");
    } else if (name == "dimsize") {
      if (!sizes_.empty()) text_.fail(value, "DimSize is given twice", kHeaderHint);
      for (const std::string_view word : words(value, 1)) sizes_.push_back(text_.count(word, "size"));
    } else if (name == "elementtype") {
      take_type(value);
    } else if (name == "elementnumberofchannels") {
      channels_ = text_.count(value, "number of components");
    } else if (name == "elementspacing") {
      spacing_ = numbers(value, 1);
    } else if (name == "elementsize") {
      element_size_ = numbers(value, 1);
    } else if (name == "offset" || name == "position" || name == "origin") {
      origin_ = numbers(value, 1);
    } else if (name == "transformmatrix" || name == "rotation" || name == "orientation") {
      rotation_ = numbers(value, dimensions_);
    } else if (name == "binarydata") {
      binary_ = flag(value);
    } else if (name == "binarydatabyteordermsb" || name == "elementbyteordermsb") {
      image_.big_endian = flag(value);
    } else if (name == "compresseddata") {
      compressed_ = flag(value);
    } else if (name == "headersize") {
      header_size_ = text_.integer(value, "size of the header of the data file");
      if (header_size_ < -1) text_.fail(value, "a header size is not below -1", kHeaderHint);
    } else if (name == "elementdatafile") {
      take_data_file(value);
    }
  }

  void take_type(std::string_view value) {
    std::string name = lower_case(value);
    if (name.ends_with("_array")) name.resize(name.size() - 6);
    type_ = find_type(kMetaTypes, name);
    if (!type_)
      text_.fail(value, "values of type " + in_quotes(value) + " are not read",
                 "integers of 1, 2, 4 and 8 bytes, MET_FLOAT and MET_DOUBLE are read");
  }

  void take_data_file(std::string_view value) {
    const std::string lower = lower_case(value);
    if (value.empty()) text_.fail(value, "the data file has no name", kHeaderHint);
    if (lower.starts_with("list") || value.find('%') != std::string_view::npos)
      text_.fail(value, "the data are spread over several files, which is not read", "write them into one file first");
    if (lower != "local") image_.data_file = std::string(value);
    ended_ = true;
  }

  // As many words as the image has dimensions, `times` over.
  std::vector<std::string_view> words(std::string_view value, std::uint64_t times) const {
    if (dimensions_ == 0) text_.fail("NDims must come before this", kHeaderHint);
    auto all = split_words(value);
    if (all.size() != dimensions_ * times)
      text_.fail(value, count_of(all.size(), "value") + " for " + count_of(dimensions_, "axis"), kHeaderHint);
    return all;
  }

  std::vector<double> numbers(std::string_view value, std::uint64_t times) const {
    std::vector<double> all;
    for (const std::string_view word : words(value, times)) all.push_back(text_.number(word, "number of an axis"));
    return all;
  }

  bool flag(std::string_view value) const {
    const std::string lower = lower_case(value);
    if (lower == "true" || lower == "1") return true;
    if (lower != "false" && lower != "0")
      text_.fail(value, in_quotes(value) + " is neither True nor False", kHeaderHint);
    return false;
  }

  void take_position() {
    GridInfo& info = image_.info;
    const auto& spacing = spacing_.empty() ? element_size_ : spacing_;
    info.has_spacing = !spacing.empty();
    for (std::size_t k = 0; k < dimensions_; ++k) {
      const double length = spacing.empty() ? 1 : spacing[k];
      if (!origin_.empty()) info.origin[k] = origin_[k];
      // The matrix has the direction of an axis in each row.
      for (std::size_t c = 0; c < dimensions_; ++c)
        info.step[k][c] = length * (rotation_.empty() ? (k == c ? 1 : 0) : rotation_[k * dimensions_ + c]);
    }
  }

  void take_header_size() {
    image_.ends_content = header_size_ == -1;
    if (header_size_ <= 0) return;
    if (image_.packing == Packing::kPlain)
      image_.skip_bytes = static_cast<std::uint64_t>(header_size_);
    else
      image_.offset = static_cast<std::uint64_t>(header_size_);
  }

  HeaderText text_;
  std::string name_;
  Image image_;
  std::uint64_t dimensions_ = 0, channels_ = 1;
  std::vector<std::uint64_t> sizes_;
  std::optional<ScalarType> type_;
  std::vector<double> spacing_, element_size_, origin_, rotation_;
  bool binary_ = true, compressed_ = false, ended_ = false;
  std::int64_t header_size_ = 0;
};

}  // namespace

bool is_meta_image(std::string_view head) {
  const std::string_view line = head.substr(0, head.find('\n'));
  const std::size_t equal = line.find('=');
  if (equal == std::string_view::npos) return false;
  const std::string_view name = without_blanks(line.substr(0, equal));
  return name == "ObjectType" || name == "NDims";
}

Image parse_meta_image(ContentSource& source) { return MetaHeader(source.view(0), source.name()).parse(); }

}  // namespace reeb::io
