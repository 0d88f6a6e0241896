#include "io/vtk/number_stream.h"

#include <algorithm>
#include <utility>

#include "io/decoding/base64_input.h"
#include "io/decoding/vtk_data.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/text_position.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kBufferBytes = 16384;

}  // namespace

NumberStream::NumberStream(const ContentSource& content, const NumberPlace& place, std::uint64_t count,
                           const char* what)
    : content_(content), place_(place), what_(what), item_bytes_(byte_size(place.type)), item_offset_(place.offset) {
  check_room(count);
  if (place_.coding == NumberCoding::kText) {
    text_.emplace(reopen_for_seeking(content));
    text_->move_forward(place_.offset);
    return;
  }
  bytes_ = std::make_unique<ContentBytes>(reopen_for_seeking(content), place_.offset);
  if (place_.coding == NumberCoding::kBase64) bytes_ = from_base64(std::move(bytes_));
  if (!place_.has_header) return;
  auto data = vtk_data(std::move(bytes_), {place_.packing, place_.wide_header, place_.big_endian});
  const std::uint64_t numbers = data->size() / item_bytes_;
  bytes_ = std::move(data);
  if (numbers < count)
    fail("an array has only " + count_of(numbers, "number") + ", but " + with_commas(count) + " are needed",
         kCutOrDamagedHint);
}

void NumberStream::check_room(std::uint64_t count) const {
  const auto size = content_.size();
  if (!size || count == 0) return;
  const std::uint64_t left = *size - std::min(place_.offset, *size);
  std::uint64_t most = most_numbers(content_, place_.offset);
  if (place_.coding == NumberCoding::kRaw) most = left / item_bytes_;
  if (place_.coding == NumberCoding::kBase64) most = (left + 1) / 4 * 3 / item_bytes_ + 1;
  if (place_.packing != BlockPacking::kNone || count <= most) return;
  fail("the file announces an array of " + count_of(count, "number") + ", more than it has room for",
       kCutOrDamagedHint);
}

std::string_view NumberStream::token() {
  while (text_->ensure(1) && is_blank_or_line_end(*text_->data())) text_->advance(1);
  item_offset_ = text_->offset();
  text_->ensure(TextCursor::kTokenBytes);
  const char* const begin = text_->data();
  const std::size_t limit = std::min(text_->available(), TextCursor::kTokenBytes);
  std::size_t length = 0;
  while (length < limit && !is_blank_or_line_end(begin[length]) && begin[length] != '<') ++length;
  if (length == TextCursor::kTokenBytes) fail("a word of more than 4096 characters", kDamagedHereHint);
  if (length != 0) text_->advance(length);
  return {begin, length};
}

const char* NumberStream::item() {
  if (buffer_.size() - taken_ < item_bytes_) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
    while (buffer_.size() < item_bytes_) {
      const std::size_t before = buffer_.size();
      buffer_.resize(kBufferBytes);
      const std::size_t got = bytes_->read(buffer_.data() + before, kBufferBytes - before);
      buffer_.resize(before + got);
      if (got == 0) {
        item_offset_ = bytes_->offset();
        fail(std::string("an array ends where a ") + what_ + " should be", kCutOrDamagedHint);
      }
    }
  }
  const char* const bytes = buffer_.data() + taken_;
  taken_ += item_bytes_;
  return bytes;
}

double NumberStream::real() {
  if (!text_) {
    const char* const bytes = item();
    if (item_bytes_ == 8) rounded_ += is_rounded_at(place_.type, bytes, place_.big_endian) ? 1u : 0u;
    return load_double(place_.type, bytes, place_.big_endian);
  }
  const std::string_view word = token();
  if (item_bytes_ == 8 && !is_float(place_.type)) rounded_ += is_rounded_text(word) ? 1u : 0u;
  if (place_.type == ScalarType::kFloat32) {
    const auto parsed = parse_number<float>(word);
    if (!parsed.ok) fail_token(word);
    return static_cast<double>(parsed.value) + 0.0;
  }
  const auto parsed = parse_number<double>(word);
  if (!parsed.ok) fail_token(word);
  return parsed.value + 0.0;
}

std::int64_t NumberStream::integer() {
  if (!text_) return load_integer(place_.type, item(), place_.big_endian);
  const std::string_view word = token();
  const auto value = whole_number<std::int64_t>(word);
  if (!value) fail_token(word);
  return *value;
}

void NumberStream::skip(std::uint64_t count) {
  for (; count != 0; --count) {
    if (text_) {
      if (token().empty()) fail_token({});
    } else {
      item();
    }
  }
}

void NumberStream::fail_token(std::string_view token) const {
  if (token.empty()) fail(std::string("an array ends where a ") + what_ + " should be", kCutOrDamagedHint);
  fail(std::string("a ") + what_ + " cannot be " + in_quotes(token), kDamagedHereHint);
}

void NumberStream::fail(const std::string& what, const std::string& hint) const {
  std::uint64_t offset = item_offset_;
  // In raw bytes, those that wait in the buffer are after the number.
  if (bytes_ && place_.coding == NumberCoding::kRaw && taken_ != 0)
    offset = bytes_->offset() - (place_.packing == BlockPacking::kNone ? buffer_.size() - taken_ + item_bytes_ : 0);
  if (bytes_ && place_.coding == NumberCoding::kBase64) offset = bytes_->offset();
  throw Error(ErrorKind::kBadInput, what, hint)
      .at(content_.name(),
          place_.coding == NumberCoding::kText ? text_position(content_, offset) : std::to_string(offset));
}

}  // namespace reeb::io
