#include "io/images/vti.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "io/decoding/base64_input.h"
#include "io/decoding/vtk_data.h"
#include "io/decoding/vtk_xml.h"
#include "io/images/header_text.h"
#include "io/text/entry_limit.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "io/text/xml_parser.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr const char* kHint = "write the file again";

struct PointDataArray {
  std::string name, type, format, offset, components;
  std::uint64_t line = 1;
};

// Follows where in the document the arrays of points are.
class ArrayPath {
 public:
  void start(const std::string& name) {
    if (name == "PointData" && path_ == "/VTKFile/ImageData/Piece") in_points_ = true;
    path_ += '/' + name;
  }
  void end(const std::string& name) {
    path_.resize(path_.size() - std::min(path_.size(), name.size() + 1));
    if (name == "PointData") in_points_ = false;
  }
  bool at_point_array() const { return in_points_ && path_.ends_with("/PointData/DataArray"); }
  bool in_cells() const { return path_ == "/VTKFile/ImageData/Piece/CellData/DataArray"; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool in_points_ = false;
};

// Reads the document up to the array that is wanted, if it is in the document, else up to the appended data.
class VtiHeader final : public XmlParser::Handler {
 public:
  explicit VtiHeader(ContentSource& source) : source_(source), xml_(source, *this) {}

  Image parse();

 private:
  bool start(const std::string& name, const XmlAttributes& attributes) override;
  bool end(const std::string& name) override {
    path_.end(name);
    return true;
  }
  bool text(std::string_view) override { return true; }

  void take_file(const XmlAttributes& attributes);
  void take_image(const XmlAttributes& attributes);
  bool take_array(const XmlAttributes& attributes);
  void take_storage(Image& image, std::size_t number);

  // These numbers of an attribute.
  template <std::size_t count>
  std::array<double, count> numbers(const XmlAttributes& attributes, const char* name,
                                    const std::array<double, count>& otherwise) const;
  std::array<std::int64_t, 6> extent(const std::string& text) const;

  ContentSource& source_;
  XmlParser xml_;
  ArrayPath path_;
  VtkXmlKind kind_;
  std::array<std::int64_t, 6> extent_{};
  std::array<double, 3> origin_{}, spacing_{1, 1, 1};
  std::array<double, 9> direction_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  bool has_image_ = false, has_piece_ = false, has_cells_ = false, has_spacing_ = false;
  std::string active_;
  std::vector<PointDataArray> arrays_;
  EntryLimit array_limit_{"arrays"};
  std::optional<std::uint64_t> appended_;  // the offset after the tag
  bool appended_base64_ = false;
};

// The text of the array of points with this number.
class ArrayText final : public ByteInput, private XmlParser::Handler {
 public:
  ArrayText(std::unique_ptr<ContentSource> source, std::size_t number)
      : source_(std::move(source)), xml_(*source_, *this), number_(number) {}

  std::size_t read(char* out, std::size_t limit) override {
    while (next_ == text_.size() && !ended_) {
      text_.clear();
      next_ = 0;
      if (!xml_.advance()) ended_ = true;
    }
    const std::size_t size = std::min(limit, text_.size() - next_);
    std::memcpy(out, text_.data() + next_, size);
    next_ += size;
    return size;
  }
  const std::string& name() const override { return source_->name(); }
  std::uint64_t offset() const override { return xml_.offset(); }
  std::uint64_t file_bytes_read() const override {
    return source_->can_seek() ? xml_.offset() : source_->file_bytes_read();
  }

 private:
  bool start(const std::string& name, const XmlAttributes&) override {
    path_.start(name);
    if (path_.at_point_array()) inside_ = arrays_++ == number_;
    return true;
  }
  bool end(const std::string& name) override {
    const bool was_it = inside_ && path_.at_point_array();
    path_.end(name);
    return !was_it;
  }
  bool text(std::string_view text) override {
    if (inside_ && path_.at_point_array()) text_ += text;
    return true;
  }

  std::unique_ptr<ContentSource> source_;
  XmlParser xml_;
  ArrayPath path_;
  std::size_t number_, arrays_ = 0;
  bool inside_ = false, ended_ = false;
  std::string text_;  // of the last window
  std::size_t next_ = 0;
};

Image VtiHeader::parse() {
  while (xml_.advance()) {
  }
  if (!has_image_ || !has_piece_) xml_.fail("the file has no ImageData with a Piece", kHint);
  if (arrays_.empty())
    xml_.fail(has_cells_ ? "the image has values of cells only, but those of points are read"
                         : "the image has no values of points",
              "write the values as point data; ParaView has a filter \"Cell Data to Point Data\"");
  auto chosen = std::ranges::find(arrays_, active_, &PointDataArray::name);
  if (active_.empty() || chosen == arrays_.end()) chosen = arrays_.begin();
  Image image;
  image.info.has_spacing = has_spacing_;
  const auto number = static_cast<std::size_t>(chosen - arrays_.begin());
  for (unsigned k = 0; k < 3; ++k) {
    for (unsigned c = 0; c < 3; ++c) image.info.step[k][c] = direction_[3 * c + k] * spacing_[k];
  }
  for (unsigned c = 0; c < 3; ++c) {
    image.info.origin[c] = origin_[c];
    for (unsigned k = 0; k < 3; ++k)
      image.info.origin[c] += static_cast<double>(extent_[2 * k]) * image.info.step[k][c];
  }
  take_storage(image, number);
  image.from_start = source_.least_offset() != 0;
  std::string others;
  for (const PointDataArray& other : arrays_)
    if (&other != &*chosen) others += (others.empty() ? "" : ", ") + other.name;
  if (!others.empty())
    image.warnings.push_back("of the arrays of points, " + chosen->name + " is read; these are not: " + others);
  return image;
}

bool VtiHeader::start(const std::string& name, const XmlAttributes& attributes) {
  path_.start(name);
  if (path_.path() == "/VTKFile") {
    take_file(attributes);
  } else if (path_.path() == "/VTKFile/ImageData") {
    take_image(attributes);
  } else if (path_.path() == "/VTKFile/ImageData/Piece") {
    if (has_piece_) xml_.fail("the image is in several pieces", "write it in one piece");
    has_piece_ = true;
    if (extent(attribute_of(attributes, "Extent")) != extent_)
      xml_.fail("the piece has another extent than the image", "write the image in one piece");
  } else if (path_.path() == "/VTKFile/ImageData/Piece/PointData") {
    active_ = attribute_of(attributes, "Scalars");
  } else if (path_.at_point_array()) {
    return take_array(attributes);
  } else if (path_.in_cells()) {
    has_cells_ = true;
  } else if (path_.path() == "/VTKFile/AppendedData") {
    appended_ = xml_.part_end();
    appended_base64_ = attribute_of(attributes, "encoding") == "base64";
    return false;
  }
  return true;
}

void VtiHeader::take_file(const XmlAttributes& attributes) {
  if (attribute_of(attributes, "type") != "ImageData")
    xml_.fail("this is not an image but " + in_quotes(attribute_of(attributes, "type")),
              "name a file of type ImageData");
  kind_ = read_vtk_xml_kind(attributes, xml_);
}

void VtiHeader::take_image(const XmlAttributes& attributes) {
  if (has_image_) xml_.fail("the file has two images", "write each into a file of its own");
  has_image_ = true;
  extent_ = extent(attribute_of(attributes, "WholeExtent"));
  origin_ = numbers<3>(attributes, "Origin", origin_);
  spacing_ = numbers<3>(attributes, "Spacing", spacing_);
  has_spacing_ = !attribute_of(attributes, "Spacing").empty();
  direction_ = numbers<9>(attributes, "Direction", direction_);
}

bool VtiHeader::take_array(const XmlAttributes& attributes) {
  PointDataArray array{attribute_of(attributes, "Name"),
                       attribute_of(attributes, "type"),
                       attribute_of(attributes, "format"),
                       attribute_of(attributes, "offset"),
                       attribute_of(attributes, "NumberOfComponents"),
                       xml_.line()};
  const bool in_document = array.format != "appended";
  const bool wanted = active_.empty() ? arrays_.empty() : array.name == active_;
  array_limit_.add(
      1, array.name.size() + array.type.size() + array.format.size() + array.offset.size() + array.components.size(),
      xml_);
  arrays_.push_back(std::move(array));
  return !(wanted && in_document);
}

template <std::size_t count>
std::array<double, count> VtiHeader::numbers(const XmlAttributes& attributes, const char* name,
                                             const std::array<double, count>& otherwise) const {
  const std::string text = attribute_of(attributes, name);
  if (text.empty()) return otherwise;
  const auto words = split_words(text);
  std::array<double, count> result{};
  bool good = words.size() == count;
  for (std::size_t i = 0; good && i < count; ++i) {
    const auto parsed = parse_number<double>(words[i]);
    good = parsed.ok && std::isfinite(parsed.value);
    result[i] = parsed.value;
  }
  if (!good) xml_.fail(std::string(name) + " is not " + std::to_string(count) + " numbers", kHint);
  return result;
}

std::array<std::int64_t, 6> VtiHeader::extent(const std::string& text) const {
  const auto words = split_words(text);
  std::array<std::int64_t, 6> result{};
  bool good = words.size() == 6;
  for (std::size_t i = 0; good && i < 6; ++i) {
    constexpr std::int64_t kLargest = std::int64_t{1} << 60;
    const auto number = whole_number<std::int64_t>(words[i]);
    good = number && -kLargest < *number && *number < kLargest;
    result[i] = number.value_or(0);
  }
  if (!good) xml_.fail("an extent is not 6 integers", kHint);
  for (std::size_t k = 0; k < 6; k += 2)
    if (result[k] > result[k + 1]) xml_.fail("the extent of the image is empty", kHint);
  return result;
}

void VtiHeader::take_storage(Image& image, std::size_t number) {
  const PointDataArray& array = arrays_[number];
  const auto type = vtk_scalar_type(array.type);
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::kBadInput, what, kHint).at(source_.name(), std::to_string(array.line) + ":1");
  };
  if (!type) refuse("values of type " + in_quotes(array.type) + " are not read");
  const unsigned components = array.components.empty() ? 1 : whole_number<unsigned>(array.components).value_or(0);
  if (components - 1 > 4095)
    refuse("the array has " + in_quotes(array.components) + " components; 1 to 4,096 are read");
  image.info.components = components;
  std::array<std::uint64_t, 3> sizes{};
  for (std::size_t k = 0; k < 3; ++k) sizes[k] = static_cast<std::uint64_t>(extent_[2 * k + 1] - extent_[2 * k]) + 1;
  set_size(image.info, sizes);
  image.type = *type;
  image.big_endian = kind_.big_endian;
  image.packing = Packing::kOwn;

  const std::uint64_t values = image.info.vertex_count() * components;
  const bool appended = array.format == "appended", base64 = !appended || appended_base64_;
  image.info.format = "VTI " + array.format;
  if (array.format == "ascii") {
    image.own_text = true;
    image.text_line = array.line;
    image.least_bytes = 2 * values - 1;
    image.open_bytes = [number](std::unique_ptr<ContentSource> source) {
      return std::make_unique<ArrayText>(std::move(source), number);
    };
    return;
  }
  if (!appended && array.format != "binary") refuse("data of the format " + in_quotes(array.format) + " are not read");
  const VtkDataKind kind{kind_.packing, kind_.wide_heads, kind_.big_endian, values * byte_size(image.type)};
  if (kind.packing != BlockPacking::kNone) image.info.format += kind.packing == BlockPacking::kZlib ? " zlib" : " lz4";
  image.least_bytes = least_stored_bytes(kind);
  if (base64) image.least_bytes += image.least_bytes / 3;
  if (!appended) {
    image.open_bytes = [number, kind](std::unique_ptr<ContentSource> source) {
      return vtk_data(from_base64(std::make_unique<ArrayText>(std::move(source), number)), kind);
    };
    return;
  }
  const auto offset = whole_number<std::uint64_t>(array.offset);
  if (!offset || *offset >> 60 != 0) refuse("the array has no valid offset in the appended data");
  if (!appended_) refuse("the file has no appended data");
  image.offset = find_appended_data(source_, xml_, *appended_) + *offset;
  if (!base64 && kind.packing == BlockPacking::kNone) image.first_value = image.offset + (kind.wide_head ? 8 : 4);
  image.open_bytes = [begin = image.offset, base64, kind](std::unique_ptr<ContentSource> source) {
    std::unique_ptr<ByteInput> bytes = std::make_unique<ContentBytes>(std::move(source), begin);
    if (base64) bytes = from_base64(std::move(bytes));
    return vtk_data(std::move(bytes), kind);
  };
}

}  // namespace

bool is_vti(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  while (!head.empty() && (head.front() == '\n' || is_blank(head.front()))) head.remove_prefix(1);
  const std::size_t begin = head.find("<VTKFile");
  if (!head.starts_with('<') || begin == std::string_view::npos) return false;
  const std::string_view tag = head.substr(begin, head.find('>', begin) - begin);
  return tag.find("type=\"ImageData\"") != std::string_view::npos ||
         tag.find("type='ImageData'") != std::string_view::npos;
}

Image parse_vti(ContentSource& source) { return VtiHeader(source).parse(); }

}  // namespace reeb::io
