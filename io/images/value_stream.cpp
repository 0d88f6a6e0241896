#include "io/images/value_stream.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "io/images/voxel_type.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kBufferBytes = 65536;

class BinaryValues final : public ValueStream {
 public:
  BinaryValues(std::unique_ptr<ByteInput> bytes, ScalarType type, bool big_endian)
      : bytes_(std::move(bytes)), type_(type), big_endian_(big_endian), buffer_(kBufferBytes) {}

  std::size_t read(std::span<double> values) override {
    const std::size_t width = byte_size(type_);
    std::size_t done = 0;
    while (done < values.size() && fill(std::min((values.size() - done) * width, kBufferBytes))) {
      const std::size_t count = filled_ / width;
      rounded_ += to_doubles(type_, big_endian_, buffer_.data(), count, values.data() + done);
      done += count;
      filled_ -= count * width;  // what is left at the end of the data is no value
    }
    return done;
  }

  bool at_end() override { return filled_ == 0 && bytes_->read(buffer_.data(), 1) == 0; }
  std::string position() const override { return std::to_string(bytes_->offset()); }
  std::uint64_t rounded() const override { return rounded_; }
  const ByteInput& bytes() const override { return *bytes_; }

 private:
  // Whether there is a whole value.
  bool fill(std::size_t wanted) {
    while (filled_ < wanted) {
      const std::size_t got = bytes_->read(buffer_.data() + filled_, wanted - filled_);
      if (got == 0) break;
      filled_ += got;
    }
    return filled_ >= byte_size(type_);
  }

  std::unique_ptr<ByteInput> bytes_;
  ScalarType type_;
  bool big_endian_;
  std::vector<char> buffer_;
  std::size_t filled_ = 0;
  std::uint64_t rounded_ = 0;
};

class TextValues final : public ValueStream {
 public:
  TextValues(std::unique_ptr<ByteInput> text, std::uint64_t line, std::uint64_t column, bool commas)
      : text_(std::move(text)), buffer_(kBufferBytes), comma_(commas ? ',' : '\n'), line_(line), column_(column) {}

  std::size_t read(std::span<double> values) override {
    std::size_t done = 0;
    while (done < values.size() && skip_blanks()) {
      const std::string_view word = token();
      const auto number = parse_number<double>(word);
      if (!number.ok)
        fail(in_quotes(word) + " is not a number (a value should be here)",
             word.find(',') == word.npos ? kCutOrDamagedHereHint : "write decimal points, and blanks between numbers");
      rounded_ += is_rounded_text(word) ? 1u : 0u;
      values[done++] = number.value + 0.0;
    }
    return done;
  }

  bool at_end() override { return !skip_blanks(); }
  std::string position() const override { return std::to_string(marked_line_) + ":" + std::to_string(marked_column_); }
  std::uint64_t rounded() const override { return rounded_; }
  const ByteInput& bytes() const override { return *text_; }

 private:
  static constexpr std::size_t kTokenBytes = TextCursor::kTokenBytes;
  bool separates(char c) const { return c == '\n' || c == comma_ || is_blank(c); }

  bool refill() {
    std::memmove(buffer_.data(), buffer_.data() + next_, filled_ - next_);
    filled_ -= next_;
    next_ = 0;
    const std::size_t got = text_->read(buffer_.data() + filled_, buffer_.size() - filled_);
    filled_ += got;
    return got != 0;
  }

  // Whether a word follows.
  bool skip_blanks() {
    while (next_ < filled_ || refill()) {
      const char c = buffer_[next_];
      if (!separates(c)) break;
      ++next_;
      ++column_;
      if (c != '\n') continue;
      ++line_;
      column_ = 1;
    }
    marked_line_ = line_;
    marked_column_ = column_;
    return next_ < filled_;
  }

  std::string_view token() {
    std::size_t length = 0;
    for (;; ++length) {
      if (length == kTokenBytes) fail("a word of more than 4096 characters");
      if (next_ + length == filled_ && !refill()) break;
      if (separates(buffer_[next_ + length])) break;
    }
    const std::string_view word(buffer_.data() + next_, length);
    next_ += length;
    column_ += length;
    return word;
  }

  [[noreturn]] void fail(const std::string& what, const char* hint = kCutOrDamagedHereHint) const {
    throw Error(ErrorKind::kBadInput, what, hint).at(text_->name(), position());
  }

  std::unique_ptr<ByteInput> text_;
  std::vector<char> buffer_;
  std::size_t next_ = 0, filled_ = 0;
  char comma_;  // a comma if it separates numbers, else a line end
  std::uint64_t rounded_ = 0;
  std::uint64_t line_, column_;
  std::uint64_t marked_line_ = 1, marked_column_ = 1;
};

}  // namespace

std::unique_ptr<ValueStream> binary_values(std::unique_ptr<ByteInput> bytes, ScalarType type, bool big_endian) {
  return std::make_unique<BinaryValues>(std::move(bytes), type, big_endian);
}

std::unique_ptr<ValueStream> text_values(std::unique_ptr<ByteInput> text, std::uint64_t line, std::uint64_t column,
                                         bool commas) {
  return std::make_unique<TextValues>(std::move(text), line, column, commas);
}

}  // namespace reeb::io
