#include "io/images/nrrd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "io/images/header_text.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

using Vector = std::vector<double>;

constexpr std::uint64_t kMaxAxes = 16;  // of the format
// Kinds of axes of the grid; any other is one of components.
constexpr std::array<std::string_view, 6> kDomains = {"domain", "space", "time", "???", "none", ""};
constexpr std::array<std::string_view, 6> kTimeSpaces = {"rast",
                                                         "last",
                                                         "lpst",
                                                         "right-anterior-superior-time",
                                                         "left-anterior-superior-time",
                                                         "left-posterior-superior-time"};

constexpr TypeName kNrrdTypes[] = {{"signed char", ScalarType::kInt8},    {"char", ScalarType::kInt8},
                                   {"unsigned char", ScalarType::kUint8}, {"uchar", ScalarType::kUint8},
                                   {"short", ScalarType::kInt16},         {"unsigned short", ScalarType::kUint16},
                                   {"ushort", ScalarType::kUint16},       {"int", ScalarType::kInt32},
                                   {"unsigned", ScalarType::kUint32},     {"uint", ScalarType::kUint32},
                                   {"long long", ScalarType::kInt64},     {"longlong", ScalarType::kInt64},
                                   {"ulonglong", ScalarType::kUint64},    {"unsigned long long", ScalarType::kUint64},
                                   {"float", ScalarType::kFloat32},       {"double", ScalarType::kFloat64},
                                   {"int8", ScalarType::kInt8},           {"uint8", ScalarType::kUint8},
                                   {"int16", ScalarType::kInt16},         {"uint16", ScalarType::kUint16},
                                   {"int32", ScalarType::kInt32},         {"uint32", ScalarType::kUint32},
                                   {"int64", ScalarType::kInt64},         {"uint64", ScalarType::kUint64}};

std::optional<ScalarType> nrrd_type(std::string_view text) {
  std::string name = lower_case(text);
  if (name.ends_with("_t")) name.resize(name.size() - 2);
  if (name.starts_with("signed ") && name != "signed char") name.erase(0, 7);
  if (name.ends_with(" int")) name.resize(name.size() - 4);
  return find_type(kNrrdTypes, name);
}

class NrrdHeader {
 public:
  NrrdHeader(std::string_view head, const std::string& name) : text_(head, name), name_(name) {}

  Image parse() {
    text_.next_line();  // the magic
    bool ended = false;
    while (!ended && text_.next_line()) {
      ended = text_.line().empty();
      if (!ended) field(text_.line());
    }
    if (!ended && (data_file_.empty() || text_.offset() == HeaderText::kMostBytes))
      fail_whole("no empty line ends the header");
    if (!type_ || sizes_.empty() || encoding_.empty())
      fail_whole(std::string("the header has no ") + (!type_ ? "type" : sizes_.empty() ? "sizes" : "encoding"));
    Image image;
    image.type = *type_;
    image.info.nodata = nodata_;
    take_axes(image);
    take_storage(image);
    image.info.format = "NRRD " + encoding_;
    return image;
  }

 private:
  // One number, word or vector for each axis.
  struct Axis {
    std::uint64_t size = 0;
    std::string kind;
    double spacing = NAN, min = NAN, max = NAN;
    bool cell = false;
    bool directed = false;  // `space directions` says "none" or a vector
    Vector direction;       // empty: none
  };

  [[noreturn]] void fail_whole(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, kHeaderHint).at(name_, std::to_string(text_.line_number()) + ":1");
  }

  void field(std::string_view line) {
    if (line.starts_with('#')) return;
    const std::size_t colon = line.find(": ");
    if (const std::size_t key_end = line.find(":="); key_end < colon) {
      // Of keys with a value, only this one means something here.
      if (without_blanks(line.substr(0, key_end)) == "nodata")
        nodata_ = text_.number(without_blanks(line.substr(key_end + 2)), "nodata");
      return;
    }
    const std::size_t end = colon == std::string_view::npos ? line.find(':') : colon;
    if (end == std::string_view::npos)
      text_.fail("this line is not a field (\"name: value\")", "an empty line must end the header");
    set_field(lower_case(without_blanks(line.substr(0, end))), without_blanks(line.substr(end + 1)));
  }

  void set_field(const std::string& name, std::string_view value) {
    if (name == "dimension") {
      dimension_ = text_.count(value, "dimension");
      if (dimension_ == 0 || dimension_ > kMaxAxes) text_.fail(value, "an image has 1 to 16 axes", kHeaderHint);
      axes_.resize(dimension_);
    } else if (name == "type") {
      type_ = nrrd_type(value);
      if (!type_) text_.fail(value, "values of type " + in_quotes(value) + " are not read", kTypeHint);
    } else if (name == "encoding") {
      encoding_ = lower_case(value);
    } else if (name == "endian") {
      big_endian_ = lower_case(value) == "big";
      if (!*big_endian_ && lower_case(value) != "little")
        text_.fail(value, "endian is neither little nor big", kHeaderHint);
    } else if (name == "sizes") {
      sizes_ = std::string(value);
      per_axis(value, [&](Axis& axis, std::string_view word) { axis.size = text_.count(word, "size"); });
    } else if (name == "kinds") {
      per_axis(value, [&](Axis& axis, std::string_view word) { axis.kind = lower_case(word); });
    } else if (name == "centers" || name == "centerings") {
      per_axis(value, [&](Axis& axis, std::string_view word) { axis.cell = lower_case(word) == "cell"; });
    } else if (name == "spacings") {
      per_axis(value, [&](Axis& axis, std::string_view word) { axis.spacing = number_or_nan(word); });
    } else if (name == "axis mins" || name == "axismins") {
      per_axis(value, [&](Axis& axis, std::string_view word) { axis.min = number_or_nan(word); });
    } else if (name == "axis maxs" || name == "axismaxs") {
      per_axis(value, [&](Axis& axis, std::string_view word) { axis.max = number_or_nan(word); });
    } else if (name == "space dimension") {
      space_ = text_.count(value, "space dimension");
    } else if (name == "space") {
      const std::string space = lower_case(value);
      space_ = space.ends_with("-time") || std::ranges::find(kTimeSpaces, space) != kTimeSpaces.end() ? 4 : 3;
    } else if (name == "space directions") {
      directions(value);
    } else if (name == "space origin") {
      std::string_view rest = value;
      origin_ = vector(rest);
    } else if (name == "line skip" || name == "lineskip") {
      line_skip_ = text_.count(value, "line skip");
    } else if (name == "byte skip" || name == "byteskip") {
      byte_skip_ = text_.integer(value, "byte skip");
      if (byte_skip_ < -1) text_.fail(value, "a byte skip is not below -1", kHeaderHint);
    } else if (name == "data file" || name == "datafile") {
      data_file_ = std::string(value);
      if (value.starts_with("LIST") || value.find('%') != std::string_view::npos)
        text_.fail(value, "the data are spread over several files, which is not read",
                   "write them into one file first");
      if (value.empty()) text_.fail(value, "the data file has no name", kHeaderHint);
    }
  }

  template <class Use>
  void per_axis(std::string_view value, const Use& use) {
    require_dimension();
    const auto words = split_words(value);
    if (words.size() != axes_.size())
      text_.fail(value, count_of(words.size(), "value") + " for " + count_of(axes_.size(), "axis"), kHeaderHint);
    for (std::size_t k = 0; k < words.size(); ++k) use(axes_[k], words[k]);
  }

  void require_dimension() const {
    if (dimension_ == 0) text_.fail("the dimension must come before this", kHeaderHint);
  }

  double number_or_nan(std::string_view word) const {
    const auto parsed = parse_number<double>(word);
    return parsed.ok && std::isnan(parsed.value) ? NAN : text_.number(word, "number of an axis");
  }

  // "(1,2,3)", which is removed from `rest`.
  Vector vector(std::string_view& rest) const {
    const std::size_t end = rest.find(')');
    if (!rest.starts_with('(') || end == std::string_view::npos)
      text_.fail(rest, "not a vector \"(x,y,z)\"", kHeaderHint);
    std::string_view inside = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
    Vector numbers;
    while (true) {
      const std::size_t comma = inside.find(',');
      numbers.push_back(text_.number(without_blanks(inside.substr(0, comma)), "component of a vector"));
      if (comma == std::string_view::npos) return numbers;
      inside.remove_prefix(comma + 1);
    }
  }

  void directions(std::string_view value) {
    require_dimension();
    std::string_view rest = value;
    for (Axis& axis : axes_) {
      rest = without_blanks(rest);
      axis.directed = true;
      if (lower_case(rest.substr(0, 4)) == "none")
        rest.remove_prefix(4);
      else
        axis.direction = vector(rest);
    }
    if (!without_blanks(rest).empty()) text_.fail(rest, "more directions than axes", kHeaderHint);
    has_directions_ = true;
  }

  static bool is_domain(const Axis& axis) {
    if (axis.directed && axis.direction.empty()) return false;
    return std::ranges::find(kDomains, axis.kind) != kDomains.end();
  }

  void take_axes(Image& image) {
    std::vector<Axis> axes = axes_;
    std::uint64_t components = 1;
    if (!axes.empty() && !is_domain(axes[0]) && axes.size() > 2) {
      components = axes[0].size;
      axes.erase(axes.begin());
    }
    while (axes.size() > 3 && axes.back().size == 1) axes.pop_back();
    for (const Axis& axis : axes)
      if (axis.directed && axis.direction.empty() && axis.size != 1)
        fail_whole("an axis of components is not the first axis");
    constexpr std::uint64_t kMostComponents = 4096;
    if (components == 0 || components > kMostComponents)
      fail_whole("a vertex has " + count_of(components, "component") + "; 1 to 4,096 are read");
    image.info.components = static_cast<unsigned>(components);
    std::vector<std::uint64_t> sizes;
    for (const Axis& axis : axes) sizes.push_back(axis.size);
    if (axes.size() > 3)
      throw Error(ErrorKind::kBadInput, "the image has " + count_of(axes.size(), "axis"),
                  "images with 2 and 3 axes are read, after an axis of components, whose kind must say so")
          .at(name_, "1:1");
    set_size(image.info, sizes);
    if (has_directions_ || !origin_.empty())
      take_space(image.info, axes);
    else
      take_spacings(image.info, axes);
  }

  void take_space(GridInfo& info, const std::vector<Axis>& axes) {
    std::uint64_t space = space_;
    for (const Axis& axis : axes)
      if (space == 0) space = axis.direction.size();
    if (space == 0) space = origin_.size();
    if (space < axes.size() || space > 3)
      fail_whole("a space of dimension " + std::to_string(space) + " for " + count_of(axes.size(), "axis"));
    info.axes = static_cast<unsigned>(space);
    info.has_spacing =
        has_directions_ || std::ranges::any_of(axes, [](const Axis& a) { return !std::isnan(a.spacing); });
    if (origin_.size() > space) fail_whole("the space origin has more numbers than the space has dimensions");
    std::ranges::copy(origin_, info.origin.begin());
    for (std::size_t k = 0; k < axes.size(); ++k) {
      if (axes[k].direction.empty()) {
        if (!std::isnan(axes[k].spacing)) info.step[k][k] = axes[k].spacing;
        continue;
      }
      if (axes[k].direction.size() != space) fail_whole("a direction does not have the dimension of the space");
      info.step[k] = {};
      std::ranges::copy(axes[k].direction, info.step[k].begin());
    }
  }

  static void take_spacings(GridInfo& info, const std::vector<Axis>& axes) {
    info.has_spacing =
        std::ranges::any_of(axes, [](const Axis& axis) { return !std::isnan(axis.spacing) || !std::isnan(axis.max); });
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const Axis& axis = axes[k];
      const std::uint64_t intervals = axis.cell ? axis.size : axis.size - 1;
      double& step = info.step[k][k];
      if (!std::isnan(axis.spacing))
        step = axis.spacing;
      else if (!std::isnan(axis.min) && !std::isnan(axis.max) && intervals != 0)
        step = (axis.max - axis.min) / static_cast<double>(intervals);
      if (!std::isnan(axis.min)) info.origin[k] = axis.cell ? axis.min + step / 2 : axis.min;
    }
  }

  void take_storage(Image& image) {
    if (encoding_ == "raw") {
      image.packing = Packing::kPlain;
    } else if (encoding_ == "gz" || encoding_ == "gzip") {
      encoding_ = "gzip";
      image.packing = Packing::kZlib;
    } else if (encoding_ == "hex") {
      image.packing = Packing::kHex;
    } else if (encoding_ == "txt" || encoding_ == "text" || encoding_ == "ascii") {
      encoding_ = "ascii";
      image.packing = Packing::kText;
      image.commas = true;
    } else {
      fail_whole("data of the encoding " + in_quotes(encoding_) + " are not read");
    }
    if (image.packing != Packing::kText && byte_size(image.type) > 1 && !big_endian_)
      fail_whole("the header has no endian, which values of more than one byte need");
    image.big_endian = big_endian_.value_or(false);
    image.data_file = data_file_;
    image.skip_lines = line_skip_;
    image.ends_content = byte_skip_ == -1;
    if (byte_skip_ > 0) image.skip_bytes = static_cast<std::uint64_t>(byte_skip_);
    if (!data_file_.empty()) return;
    image.offset = text_.offset();
    image.text_line = text_.line_number() + 1;
  }

  static constexpr const char* kTypeHint = "integers of 1, 2, 4 and 8 bytes, float and double are read";

  HeaderText text_;
  std::string name_;
  std::uint64_t dimension_ = 0, space_ = 0;
  std::vector<Axis> axes_;
  std::optional<ScalarType> type_;
  std::optional<bool> big_endian_;
  std::string encoding_, sizes_, data_file_;
  Vector origin_;
  std::optional<double> nodata_;
  bool has_directions_ = false;
  std::uint64_t line_skip_ = 0;
  std::int64_t byte_skip_ = 0;
};

}  // namespace

bool is_nrrd(std::string_view head) { return head.starts_with("NRRD000"); }

Image parse_nrrd(ContentSource& source) { return NrrdHeader(source.view(0), source.name()).parse(); }

}  // namespace reeb::io
