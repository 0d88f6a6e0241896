#include "io/images/esri_grid.h"

#include <array>
#include <optional>

#include "io/images/header_text.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// The lower left end of the grid along an axis: the border of a cell, or its centre.
struct LowEnd {
  double value = 0;
  bool centre = false;
  double first_centre(double cell) const { return centre ? value : value + cell / 2; }
};

class EsriHeader {
 public:
  EsriHeader(std::string_view head, const std::string& name) : text_(head, name), name_(name) {}

  Image parse() {
    Image image;
    std::size_t data = 0;
    bool ended = false;
    while (!ended) {
      data = text_.offset();
      if (!text_.next_line()) break;
      const auto words = split_words(text_.line());
      if (words.empty()) continue;
      ended = parse_number<double>(words[0]).ok;
      if (!ended) field(words, image.info);
    }
    if (columns_ == 0 || rows_ == 0) fail_whole("the header has no ncols or no nrows");
    if (!dx_ || !dy_) fail_whole("the header has no cellsize");
    image.info.format = "ESRI ASCII grid";
    set_size(image.info, std::array{columns_, rows_});
    image.info.origin = {x_.first_centre(*dx_), y_.first_centre(*dy_) + static_cast<double>(rows_ - 1) * *dy_, 0};
    image.info.step[0] = {*dx_, 0, 0};
    image.info.step[1] = {0, -*dy_, 0};
    image.packing = Packing::kText;
    image.offset = data;
    image.text_line = ended ? text_.line_number() : text_.line_number() + 1;
    return image;
  }

 private:
  [[noreturn]] void fail_whole(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, kHeaderHint).at(name_, std::to_string(text_.line_number()) + ":1");
  }

  void field(const std::vector<std::string_view>& words, GridInfo& info) {
    const std::string name = lower_case(words[0]);
    if (words.size() != 2) text_.fail("this line is neither a name and a number nor a row of heights", kHeaderHint);
    const std::string_view value = words[1];
    if (name == "ncols") {
      columns_ = text_.count(value, "number of columns");
    } else if (name == "nrows") {
      rows_ = text_.count(value, "number of rows");
    } else if (name == "xllcorner" || name == "xllcenter") {
      x_ = {text_.number(value, "x of the lower left"), name == "xllcenter"};
    } else if (name == "yllcorner" || name == "yllcenter") {
      y_ = {text_.number(value, "y of the lower left"), name == "yllcenter"};
    } else if (name == "cellsize") {
      dx_ = dy_ = cell(value);
    } else if (name == "dx") {
      dx_ = cell(value);
    } else if (name == "dy") {
      dy_ = cell(value);
    } else if (name == "nodata_value") {
      const auto parsed = parse_number<double>(value);
      if (!parsed.ok) text_.fail(value, in_quotes(value) + " is not a number (NODATA_value)", kHeaderHint);
      info.nodata = parsed.value + 0.0;
    } else {
      text_.fail("a header has no field " + in_quotes(words[0]), kHeaderHint);
    }
  }

  double cell(std::string_view value) const {
    const double size = text_.number(value, "size of a cell");
    if (size <= 0) text_.fail(value, "the size of a cell is not positive", kHeaderHint);
    return size;
  }

  HeaderText text_;
  std::string name_;
  std::uint64_t columns_ = 0, rows_ = 0;
  LowEnd x_, y_;
  std::optional<double> dx_, dy_;
};

}  // namespace

bool is_esri_grid(std::string_view head) {
  const auto words = split_words(head.substr(0, std::min<std::size_t>(head.find('\n'), 100)));
  return words.size() == 2 && (lower_case(words[0]) == "ncols" || lower_case(words[0]) == "nrows");
}

Image parse_esri_grid(ContentSource& source) { return EsriHeader(source.view(0), source.name()).parse(); }

}  // namespace reeb::io
