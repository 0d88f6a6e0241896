#include "io/streaming/text_lines.h"

#include <fast_float/fast_float.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "io/events/stream_fault.h"

namespace reeb::io {
namespace {

constexpr std::array<bool, 256> control_bytes() {
  std::array<bool, 256> control{};
  for (std::size_t c = 0; c < 0x20; ++c) control[c] = c != '\t' && c != '\n' && c != '\r';
  control[0x7F] = true;
  return control;
}
constexpr auto kControl = control_bytes();

bool has_control_byte(std::string_view line) {
  bool found = false;
  for (const char c : line) found |= kControl[static_cast<unsigned char>(c)];
  return found;
}

// `text` is the part after "0x". Underflow gives 0, as for decimal numbers; overflow gives infinity.
bool parse_hexadecimal(std::string_view text, float& value) {
  const char* end = text.data() + text.size();
  const auto narrow = std::from_chars(text.data(), end, value, std::chars_format::hex);
  if (narrow.ptr != end) return false;
  if (narrow.ec != std::errc::result_out_of_range) return narrow.ec == std::errc();
  double wide = 0;
  const auto again = std::from_chars(text.data(), end, wide, std::chars_format::hex);
  const bool tiny = again.ec == std::errc() ? std::abs(wide) < 1 : text.find_first_of("pP") + 1 == text.find('-');
  value = tiny ? 0.0f : HUGE_VALF;
  return true;
}

bool parse_float(std::string_view text, float& value) {
  const bool negative = !text.empty() && text[0] == '-';
  std::string_view digits = text;
  if (!digits.empty() && (digits[0] == '-' || digits[0] == '+')) digits.remove_prefix(1);
  if (digits.empty() || digits[0] == '-' || digits[0] == '+') return false;
  if (digits.size() > 2 && digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X')) {
    if (digits[2] == '-' || !parse_hexadecimal(digits.substr(2), value)) return false;
  } else {
    const char* end = digits.data() + digits.size();
    const auto result = fast_float::from_chars(digits.data(), end, value);
    if (result.ec == std::errc::invalid_argument || result.ptr != end) return false;
  }
  if (negative) value = -value;
  return true;
}

}  // namespace

std::optional<std::string_view> LineScanner::next() {
  if (put_back_) {
    put_back_ = false;
    return line_;
  }
  cursor_.advance(length_);
  length_ = 0;
  std::size_t searched = 0;
  const void* end = nullptr;
  for (;;) {
    const std::size_t available = cursor_.available();
    if (available > searched) {
      end = std::memchr(cursor_.data() + searched, '\n', available - searched);
      searched = available;
    }
    if (end != nullptr || searched > kMaxLine || !cursor_.ensure(searched + 1)) break;
  }
  if (end == nullptr && searched == 0) return std::nullopt;
  ++number_;
  unfinished_ = end == nullptr;
  const char* begin = cursor_.data();
  std::size_t size = unfinished_ ? searched : static_cast<std::size_t>(static_cast<const char*>(end) - begin);
  length_ = size + (unfinished_ ? 0 : 1);
  if (size > 0 && begin[size - 1] == '\r') --size;
  line_ = std::string_view(begin, std::min(size, kMaxLine));
  if (has_control_byte(line_))
    fail(Fault::kUnsupported, "binary data in line " + std::to_string(number_), std::to_string(number_) + ":1");
  if (size > kMaxLine)
    fail(Fault::kBadNumber, "line is longer than " + std::to_string(kMaxLine) + " characters",
         std::to_string(number_) + ":1");
  return line_;
}

std::string_view LineCursor::word() {
  skip_blanks();
  while (at_ < line_.size() && !is_blank(line_[at_])) ++at_;
  return last_word();
}

std::string_view LineCursor::last_word() const { return line_.substr(token_, at_ - token_); }

NumberVerdict LineCursor::number(float& value) {
  const std::string_view text = word();
  if (text.empty()) return NumberVerdict::kMissing;
  if (!parse_float(text, value)) return NumberVerdict::kNotANumber;
  return std::isfinite(value) ? NumberVerdict::kValid : NumberVerdict::kOutOfRange;
}

NumberVerdict LineCursor::number(std::int32_t& value) {
  std::string_view text = word();
  if (text.empty()) return NumberVerdict::kMissing;
  if (text[0] == '+' && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) return NumberVerdict::kNotANumber;
  return result.ec == std::errc() ? NumberVerdict::kValid : NumberVerdict::kOutOfRange;
}

}  // namespace reeb::io
