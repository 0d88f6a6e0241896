#include "io/text/text_cursor.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>

#include "io/text/hints.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {

template <class Float>
ParsedNumber<Float> parse_number(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
  ParsedNumber<Float> result;
  const char* const end = token.data() + token.size();
  const auto parsed = fast_float::from_chars(token.data(), end, result.value);
  result.ok = parsed.ec != std::errc::invalid_argument && parsed.ptr == end && !token.empty();
  return result;
}
template ParsedNumber<float> parse_number<float>(std::string_view);
template ParsedNumber<double> parse_number<double>(std::string_view);

std::uint64_t most_numbers(const ContentSource& content, std::uint64_t offset) {
  const auto size = content.size();
  if (!size) return ~std::uint64_t{0};
  return (*size - std::min(*size, offset) + 1) / 2;  // the last separator may be missing
}

bool spells_non_finite(std::string_view token) {
  if (!token.empty() && (token[0] == '-' || token[0] == '+')) token.remove_prefix(1);
  return !token.empty() && (token[0] == 'n' || token[0] == 'N' || token[0] == 'i' || token[0] == 'I');
}

void TextCursor::skip_byte_order_mark() {
  cursor_.ensure(3);
  if (std::string_view(cursor_.data(), cursor_.available()).starts_with("\xEF\xBB\xBF")) {
    cursor_.advance(3);
    line_begin_ = 3;
  }
}

bool TextCursor::skip_continuation() {
  cursor_.ensure(3);
  const std::string_view ahead(cursor_.data(), cursor_.available());
  if (ahead.starts_with("\\\r\n"))
    cursor_.advance(2);
  else if (ahead.starts_with("\\\n"))
    cursor_.advance(1);
  else
    return false;
  pass_newline();
  return true;
}

bool TextCursor::more() {
  while (!more_on_line()) {
    if (cursor_.at_end()) return false;
    skip_line();
  }
  return true;
}

bool TextCursor::skip_to_name() {
  while (more()) {
    if (is_letter(peek())) return true;
    // Passes over words of the line, as long as no other one begins with a letter or a comment.
    cursor_.ensure(kTokenBytes);
    const std::string_view ahead(cursor_.data(), cursor_.available());
    std::size_t end = 0, length = 0;  // of the words passed over; what was looked at
    while (length < ahead.size() && ahead[length] != '\n') {
      while (length < ahead.size() && !is_blank_or_line_end(ahead[length])) ++length;
      if (length == ahead.size()) break;
      while (length < ahead.size() && is_blank(ahead[length])) ++length;
      end = length;
      if (length < ahead.size() && (is_letter(ahead[length]) || ahead[length] == '#')) break;
    }
    if (end == 0)
      (void)token();
    else
      cursor_.advance(end);
  }
  return false;
}

void TextCursor::fail_at_end(const char* what) {
  mark();
  fail(std::string("the file ends where a ") + what + " should be", kCutHint);
}

void TextCursor::require_room(std::uint64_t records, std::uint64_t numbers) const {
  if (records > most_numbers(source(), cursor_.offset()) / numbers)
    fail("the file announces " + count_of(records, "record") + " here, more than it has room for", kCutOrDamagedHint);
}

void TextCursor::skip_line() {
  // A comment is not continued: some end with a Windows path, and so with a backslash.
  const bool may_continue = style_.continuation && more_on_line();
  bool continued = false;  // the last byte but CR was a backslash
  while (cursor_.ensure(1)) {
    const char* const begin = cursor_.data();
    const void* const found = std::memchr(begin, '\n', cursor_.available());
    const std::size_t length =
        found == nullptr ? cursor_.available() : static_cast<std::size_t>(static_cast<const char*>(found) - begin);
    std::size_t last = length;
    if (last != 0 && begin[last - 1] == '\r') --last;
    if (last != 0) continued = begin[last - 1] == '\\';
    cursor_.advance(length);
    if (found == nullptr) continue;
    pass_newline();
    if (!continued || !may_continue) return;
    continued = false;
  }
}

std::string_view TextCursor::token() {
  if (!more_on_line()) {
    mark();
    return {};
  }
  mark();
  cursor_.ensure(kTokenBytes);
  const char* const begin = cursor_.data();
  const std::size_t limit = std::min(cursor_.available(), kTokenBytes);
  std::size_t length = 0;
  while (length < limit && !is_blank_or_line_end(begin[length])) ++length;
  if (length == kTokenBytes) fail("a word of more than 4096 characters", "check that this is a text file");
  if (style_.continuation && length > 1 && begin[length - 1] == '\\') --length;
  cursor_.advance(length);
  return {begin, length};
}

template <class Float>
Float TextCursor::finite_number(const char* what) {
  skip_blanks();
  cursor_.ensure(kTokenBytes);
  const char* const begin = cursor_.data();
  const std::size_t limit = std::min(cursor_.available(), kTokenBytes);
  const char* const end = begin + limit;
  Float value = 0;
  const auto parsed = fast_float::from_chars(begin, end, value);
  const bool ends = parsed.ptr == end ? limit < kTokenBytes : is_blank_or_line_end(*parsed.ptr);
  const bool whole = parsed.ec == std::errc{} && ends;
  if (!whole || !std::isfinite(value)) [[unlikely]]
    return slow_number<Float>(what);
  mark();
  cursor_.advance(static_cast<std::size_t>(parsed.ptr - begin));
  return value + static_cast<Float>(zero_);
}
template float TextCursor::finite_number<float>(const char*);
template double TextCursor::finite_number<double>(const char*);

template <class Float>
Float TextCursor::any_number(const char* what) {
  skip_blanks();
  cursor_.ensure(2);  // a sign and a letter
  if (!spells_non_finite({cursor_.data(), std::min<std::size_t>(cursor_.available(), 2)}))
    return finite_number<Float>(what);
  const std::string_view word = token();
  const auto parsed = parse_number<Float>(word);
  if (!parsed.ok) fail_number(word, what);
  return parsed.value;
}
template float TextCursor::any_number<float>(const char*);
template double TextCursor::any_number<double>(const char*);

// The rare cases: a plus sign, a number that ends in a continuation, one that is too long, and everything invalid.
template <class Float>
Float TextCursor::slow_number(const char* what) {
  const std::string_view word = token();
  const auto parsed = parse_number<Float>(word);
  if (!parsed.ok || !std::isfinite(parsed.value)) [[unlikely]]
    fail_number(word, what);
  return parsed.value + static_cast<Float>(zero_);
}

std::int64_t TextCursor::integer(const char* what) {
  const std::string_view word = token();
  const std::string_view digits = word.size() > 1 && word[0] == '+' ? word.substr(1) : word;
  std::int64_t value = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != digits.data() + digits.size()) fail_number(word, what);
  return value;
}

void TextCursor::fail_digits(const char* what, const std::string& hint) {
  if (const char next = peek(); next < '0' || next > '9') fail(std::string("a ") + what + " should be here", hint);
  fail(std::string("a ") + what + " of more than 18 digits is too large", "fix this number in the file");
}

void TextCursor::fail_number(std::string_view token, const char* what) const {
  if (token.empty()) fail(std::string("the line ends where a ") + what + " should be", kCutOrDamagedHereHint);
  if (parse_number<double>(token).ok)
    fail(std::string("a ") + what + " cannot be " + in_quotes(token), "fix this value in the file");
  fail(in_quotes(token) + " is not a number (a " + what + " should be here)", kCutOrDamagedHereHint);
}

std::string TextCursor::position() const { return std::to_string(marked_line_) + ":" + std::to_string(marked_column_); }

void TextCursor::fail(const std::string& what, const std::string& hint) const {
  throw Error(ErrorKind::kBadInput, what, hint).at(source().name(), position());
}

}  // namespace reeb::io
