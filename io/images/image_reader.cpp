#include "io/images/image_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/decoding/hex_input.h"
#include "io/decoding/inflate_input.h"
#include "io/images/value_stream.h"
#include "io/images/voxel_type.h"
#include "io/mesh/property_columns.h"
#include "io/text/hints.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

class ImageReader final : public GridReader {
 public:
  ImageReader(Image image, Input data, std::unique_ptr<ContentSource> source)
      : image_(std::move(image)), data_(std::move(data)), name_(source->name()) {
    image_.info.file_bytes = source->file_bytes();
    image_.info.value_type = type_name(image_.type);
    values_ = image_.info.vertex_count() * image_.info.components;
    check_position();
    locate(*source);
    check_room(*source);
    stream_ = open(std::move(source));
  }

  const GridInfo& info() const override { return image_.info; }

  std::size_t read(std::span<double> values) override {
    const std::uint64_t wanted = std::min<std::uint64_t>(values.size(), values_ - read_);
    const auto part = values.first(static_cast<std::size_t>(wanted));
    const std::size_t got = stream_->read(part);
    read_ += got;
    if (got < wanted) fail_cut();
    if (image_.scaled)
      for (double& value : part) value = value * image_.slope + image_.intercept + 0.0;
    if (wanted != 0 && read_ == values_) check_end();
    return part.size() / image_.info.components;
  }

  void rewind() override {
    if (read_ == 0) return;
    if (!data_.can_reopen())
      throw Error(ErrorKind::kBadInput, "the image is needed twice, but the input can be read only once",
                  "write it to a file, and name that")
          .at(name_);
    stream_ = open(data_.open());
    read_ = 0;
  }

  GridPlace place_of(std::uint64_t vertex) const override {
    const std::uint64_t value = vertex * image_.info.components;
    const auto first = image_.packing == Packing::kPlain ? image_.offset : image_.first_value;
    if (first) return {name_, std::to_string(*first + value * byte_size(image_.type))};
    // In packed data a place says nothing; in text it is a line.
    const bool text = image_.packing == Packing::kText || image_.own_text;
    if (!text || !data_.can_reopen()) return {name_, {}};
    const auto again = open(data_.open());
    std::vector<double> some(4096);
    for (std::uint64_t left = value + 1; left != 0;) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, some.size()));
      if (again->read(std::span(some).first(count)) < count) return {name_, {}};
      left -= count;
    }
    return {name_, again->position()};
  }

  std::uint64_t bytes_read() const override { return stream_->bytes().file_bytes_read(); }
  std::uint64_t memory_bytes() const override { return stream_->bytes().memory_bytes(); }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = image_.warnings;
    if (stream_->rounded() != 0) all.push_back(note_on_rounded_values(stream_->rounded()));
    if (trailing_) all.push_back("data after the last value were ignored");
    return all;
  }

 private:
  void check_position() const {
    bool finite = true;
    for (unsigned c = 0; c < 3; ++c) {
      finite = finite && std::isfinite(image_.info.origin[c]);
      for (const auto& step : image_.info.step) finite = finite && std::isfinite(step[c]);
    }
    if (!finite || !std::isfinite(image_.slope) || !std::isfinite(image_.intercept))
      throw Error(ErrorKind::kBadInput, "the header has an origin, a spacing or a scale that is not finite",
                  kHeaderHint)
          .at(name_);
  }

  // Makes `offset` the place of the data.
  void locate(ContentSource& source) {
    for (; image_.skip_lines != 0; --image_.skip_lines) skip_line(source);
    if (image_.packing == Packing::kText)
      skip_text(source);
    else if (image_.packing != Packing::kZlib)
      image_.offset += std::exchange(image_.skip_bytes, 0);
    if (!image_.ends_content) return;
    const auto size = source.size();
    if (!size || image_.packing != Packing::kPlain)
      throw Error(ErrorKind::kBadInput,
                  "the header says that the data are the last bytes of a file whose size is not known",
                  "unpack the file, or give the number of bytes to skip")
          .at(name_);
    const std::uint64_t bytes = values_ * byte_size(image_.type);
    if (bytes > *size) fail_short(*size, bytes);
    image_.offset = *size - bytes;
  }

  // Skips bytes and counts their lines.
  void skip_text(ContentSource& source) {
    while (image_.skip_bytes != 0) {
      const std::string_view bytes = view_before_data(source).substr(0, image_.skip_bytes);
      image_.text_line += static_cast<std::uint64_t>(std::ranges::count(bytes, '\n'));
      const std::size_t line_end = bytes.rfind('\n');
      image_.text_column =
          line_end == std::string_view::npos ? image_.text_column + bytes.size() : bytes.size() - line_end;
      image_.offset += bytes.size();
      image_.skip_bytes -= bytes.size();
    }
  }

  std::string_view view_before_data(ContentSource& source) const {
    const std::string_view bytes = source.view(image_.offset, 1);
    if (!bytes.empty()) return bytes;
    throw Error(ErrorKind::kBadInput, "the file ends before its data", kCutOrHeaderHint)
        .at(name_, std::to_string(image_.offset));
  }

  void skip_line(ContentSource& source) {
    for (;;) {
      const std::string_view bytes = view_before_data(source);
      const std::size_t end = bytes.find('\n');
      image_.offset += end == std::string_view::npos ? bytes.size() : end + 1;
      if (end == std::string_view::npos) continue;
      ++image_.text_line;
      return;
    }
  }

  // The least number of bytes of content that can hold all values.
  std::uint64_t least_bytes() const {
    const std::uint64_t bytes = values_ * byte_size(image_.type);
    switch (image_.packing) {
      case Packing::kPlain:
        return bytes;
      case Packing::kZlib:
        return bytes / kMostInflated;
      case Packing::kHex:
        return 2 * bytes;
      case Packing::kText:
        return 2 * values_ - 1;
      case Packing::kOwn:
        break;
    }
    return image_.least_bytes;
  }

  void check_room(const ContentSource& source) const {
    const auto size = source.size();
    if (!size) return;
    const std::uint64_t left = *size - std::min(image_.offset, *size), least = least_bytes();
    if (left < least) fail_short(left, least);
    if (image_.must_end && image_.packing == Packing::kPlain && left > least)
      throw Error(ErrorKind::kBadInput,
                  "the grid has " + count_of(values_, "value") + " (" + count_of(least, "byte") +
                      "), but the file holds " + count_of(left, "byte"),
                  "check the size and the type of the grid, and the bytes to skip")
          .at(name_, std::to_string(image_.offset + least));
  }

  [[noreturn]] void fail_short(std::uint64_t left, std::uint64_t least) const {
    const bool exact = image_.packing == Packing::kPlain;
    throw Error(ErrorKind::kBadInput,
                (image_.must_end ? "the grid has " : "the header announces ") + count_of(values_, "value") + " (" +
                    (exact ? "" : "at least ") + count_of(least, "byte") + "), but the file holds " +
                    count_of(left, "byte") + " of data",
                image_.must_end ? "check the size and the type of the grid" : kCutOrHeaderHint)
        .at(name_, std::to_string(image_.offset));
  }

  [[noreturn]] void fail_cut() const {
    throw Error(ErrorKind::kBadInput, "the file ends after " + with_commas(read_) + " of " + count_of(values_, "value"),
                image_.must_end ? "check the size and the type of the grid" : kCutOrHeaderHint)
        .at(name_, stream_->position());
  }

  std::unique_ptr<ValueStream> open(std::unique_ptr<ContentSource> source) const {
    if (image_.packing == Packing::kOwn) {
      auto bytes = image_.open_bytes(std::move(source));
      if (image_.own_text) return text_values(std::move(bytes), image_.text_line, image_.text_column, image_.commas);
      return binary_values(std::move(bytes), image_.type, image_.big_endian);
    }
    std::unique_ptr<ByteInput> bytes = std::make_unique<ContentBytes>(std::move(source), image_.offset);
    if (image_.packing == Packing::kText)
      return text_values(std::move(bytes), image_.text_line, image_.text_column, image_.commas);
    if (image_.packing == Packing::kZlib) bytes = inflate(std::move(bytes));
    if (image_.packing == Packing::kHex) bytes = from_hex(std::move(bytes));
    char skipped[4096];
    for (std::uint64_t left = image_.skip_bytes; left != 0;) {
      const std::size_t got = bytes->read(skipped, static_cast<std::size_t>(std::min<std::uint64_t>(left, 4096)));
      if (got == 0) break;
      left -= got;
    }
    return binary_values(std::move(bytes), image_.type, image_.big_endian);
  }

  void check_end() {
    if (stream_->at_end()) {
      trailing_ = false;
    } else if (image_.must_end) {
      throw Error(ErrorKind::kBadInput, "the file holds more than the " + count_of(values_, "value") + " of the grid",
                  "check the size and the type of the grid, and the bytes to skip")
          .at(name_, stream_->position());
    } else {
      trailing_ = true;
    }
    data_.check_unchanged("the image");
  }

  Image image_;
  Input data_;
  std::string name_;
  std::uint64_t values_ = 0, read_ = 0;
  std::unique_ptr<ValueStream> stream_;
  bool trailing_ = false;
};

}  // namespace

std::unique_ptr<GridReader> read_image(Image image, Input data, std::unique_ptr<ContentSource> source) {
  return std::make_unique<ImageReader>(std::move(image), std::move(data), std::move(source));
}

}  // namespace reeb::io
