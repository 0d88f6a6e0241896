#include "io/images/numpy.h"

#include <algorithm>

#include "io/images/header_text.h"
#include "io/mesh/scalar_bytes.h"
#include "io/text/hints.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

class NumpyParser {
 public:
  NumpyParser(std::string_view head, std::string name) : name_(std::move(name)) {
    const std::size_t length_bytes = head.size() > 6 && head[6] == 1 ? 2 : 4;
    if (head.size() < 8 + length_bytes) fail(head.size(), "the file ends inside its header");
    if (head[6] < 1 || head[6] > 3) fail(6, "version " + std::to_string(head[6]) + " of the format is not read");
    const std::uint64_t length = length_bytes == 2 ? load_scalar<std::uint16_t>(head.data() + 8, false)
                                                   : load_scalar<std::uint32_t>(head.data() + 8, false);
    begin_ = 8 + length_bytes;
    if (length > head.size() - begin_)
      fail(8, head.size() < ContentSource::kLookahead ? "the file ends inside its header"
                                                      : "the header is longer than that of an array of numbers");
    text_ = head.substr(begin_, static_cast<std::size_t>(length));
  }

  NumpyHeader parse() const {
    NumpyHeader header;
    take_type(header);
    take_shape(header);
    header.body_offset = begin_ + text_.size();
    return header;
  }

 private:
  [[noreturn]] void fail(std::uint64_t offset, const std::string& what,
                         const std::string& hint = kCutOrDamagedHint) const {
    throw Error(ErrorKind::kBadInput, what, hint).at(name_, std::to_string(offset));
  }
  [[noreturn]] void fail(std::string_view part, const std::string& what, const std::string& hint) const {
    fail(begin_ + static_cast<std::uint64_t>(part.data() - text_.data()), what, hint);
  }

  // The text after a key of the dictionary and its colon.
  std::string_view value(std::string_view key) const {
    for (const char quote : {'\'', '"'}) {
      std::string quoted_key(1, quote);
      quoted_key.append(key).push_back(quote);
      const std::size_t at = text_.find(quoted_key);
      if (at == std::string_view::npos) continue;
      const std::string_view rest = without_blanks(text_.substr(at + quoted_key.size()));
      if (rest.starts_with(':')) return without_blanks(rest.substr(1));
    }
    fail(begin_, "the header has no " + std::string(key));
  }

  void take_type(NumpyHeader& header) const {
    const std::string_view rest = value("descr");
    const std::size_t end = rest.empty() ? 0 : rest.find(rest.front(), 1);
    const bool is_quoted = !rest.empty() && (rest.front() == '\'' || rest.front() == '"');
    if (!is_quoted || end == std::string_view::npos || end < 3)
      fail(rest, "an array of records is not read", "save an array of numbers");
    const std::string_view word = rest.substr(1, end - 1);
    header.big_endian = word[0] == '>';
    const std::string_view type = word.substr(1);
    static constexpr std::pair<std::string_view, ScalarType> kTypes[] = {
        {"i1", ScalarType::kInt8},    {"u1", ScalarType::kUint8},  {"b1", ScalarType::kUint8},
        {"i2", ScalarType::kInt16},   {"u2", ScalarType::kUint16}, {"i4", ScalarType::kInt32},
        {"u4", ScalarType::kUint32},  {"i8", ScalarType::kInt64},  {"u8", ScalarType::kUint64},
        {"f4", ScalarType::kFloat32}, {"f8", ScalarType::kFloat64}};
    const auto* const found = std::ranges::find(kTypes, type, [](const auto& known) { return known.first; });
    if (found == std::end(kTypes) || std::string_view("<>|=").find(word[0]) == std::string_view::npos)
      fail(word, "values of type " + in_quotes(word) + " are not read",
           "save the array as integers of 1, 2, 4 or 8 bytes, float32 or float64");
    header.type = found->second;
  }

  void take_shape(NumpyHeader& header) const {
    const std::string_view rest = value("shape");
    const std::size_t end = rest.find(')');
    if (!rest.starts_with('(') || end == std::string_view::npos) fail(rest, "the shape is not a list", kHint);
    for (std::string_view left = rest.substr(1, end - 1); !without_blanks(left).empty();) {
      const std::size_t comma = std::min(left.find(','), left.size());
      std::string_view word = without_blanks(left.substr(0, comma));
      left.remove_prefix(std::min(comma + 1, left.size()));
      if (word.ends_with('L')) word.remove_suffix(1);  // of Python 2
      const auto size = whole_number<std::uint64_t>(word);
      if (!size) fail(word, "the shape has " + in_quotes(word) + ", which is not a size", kHint);
      header.shape.push_back(*size);
    }
    const std::string_view order = value("fortran_order");
    if (!order.starts_with("True") && !order.starts_with("False")) fail(order, "neither True nor False", kHint);
    header.fortran_order = order.starts_with("True");
  }

  static constexpr const char* kHint = "save the array again";

  std::string name_;
  std::string_view text_;
  std::uint64_t begin_ = 0;
};

}  // namespace

std::string numpy_header(std::uint64_t count) {
  constexpr std::size_t kBytes = 128, kDictionary = kBytes - 10;  // NumPy aligns the values to 64 bytes
  std::string header(kMagic);
  for (const unsigned byte : {1u, 0u, static_cast<unsigned>(kDictionary), 0u}) header += static_cast<char>(byte);
  header += "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(count) + ",), }";
  header.resize(kBytes - 1, ' ');
  return header + '\n';
}

bool is_numpy(std::string_view head) { return head.starts_with(kMagic); }

NumpyHeader parse_numpy_header(std::string_view head, const std::string& name) {
  return NumpyParser(head, name).parse();
}

Image parse_numpy(ContentSource& source) {
  NumpyHeader header = parse_numpy_header(source.view(0), source.name());
  Image image;
  image.info.format = "NumPy array";
  image.info.has_spacing = false;
  image.type = header.type;
  image.big_endian = header.big_endian;
  image.offset = header.body_offset;
  if (!header.fortran_order) std::ranges::reverse(header.shape);
  set_size(image.info, header.shape);
  return image;
}

}  // namespace reeb::io
