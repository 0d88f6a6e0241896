// Tokens, numbers and lines of a text format, read directly from the windows of the input.
//
// Lines end with LF or CR LF; blanks are space, tab and CR. Nothing is copied. A line can have any length: only a token
// must be contiguous (kTokenBytes).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "io/text/cursor.h"
#include "io/text/plain_line.h"

namespace reeb::io {

// A parsed number; `ok` is false if the token is not a number. Values out of the range of the type become infinities or
// zero. The caller decides about these and NaN.
template <class Float>
struct ParsedNumber {
  Float value = 0;
  bool ok = false;
};
template <class Float>
ParsedNumber<Float> parse_number(std::string_view token);
extern template ParsedNumber<float> parse_number<float>(std::string_view);
extern template ParsedNumber<double> parse_number<double>(std::string_view);

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
inline bool is_blank_or_line_end(char c) { return c == '\n' || is_blank(c); }
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// Whether the token spells NaN or an infinity ("nan", "-inf", "Infinity", ...).
bool spells_non_finite(std::string_view token);

// How many numbers the content can have from `offset` on: each needs a digit and a separator.
std::uint64_t most_numbers(const ContentSource& content, std::uint64_t offset);

// What a format allows in addition to plain lines of words.
struct TextStyle {
  bool comments = false;      // a word that begins with # ends the line
  bool continuation = false;  // a backslash at the end of a line is a blank, and so is the line end
};

class TextCursor {
 public:
  static constexpr std::size_t kTokenBytes = 4096;

  explicit TextCursor(std::unique_ptr<ContentSource> source, TextStyle style = {})
      : cursor_(std::move(source)), style_(style) {
    skip_byte_order_mark();
  }

  // Skips blanks. True if a token follows on this line.
  bool more_on_line() {
    skip_blanks();
    if (cursor_.available() == 0) return false;
    const char c = *cursor_.data();
    return c != '\n' && (c != '#' || !style_.comments);
  }
  // Moves to the next token, across line ends. False at the end of the input.
  bool more();
  // The same. THROWS: Error{kBadInput} at the end of the input; `what` names what should be there ("coordinate").
  void require_more(const char* what) {
    if (!more_on_line() && !more()) fail_at_end(what);
  }
  // THROWS: Error{kBadInput} at position() if the rest of the input is too short for this many records of this many
  // numbers each. REQUIRES: numbers > 0.
  void require_room(std::uint64_t records, std::uint64_t numbers) const;
  // Moves past the end of this line and its continuations.
  void skip_line();
  // Moves to the next word that begins with a letter, across line ends. False if there is none.
  bool skip_to_name();
  // Reads a line of numbers at once: true if `read(PlainLine&)` returns true and nothing is left on the line. Else, or
  // if the line is longer than a token may be, does not move, and the caller reads the line word by word.
  template <class Read>
  bool plain_line(Read&& read) {
    cursor_.ensure(kTokenBytes);
    const std::size_t limit = cursor_.available() < kTokenBytes ? cursor_.available() : kTokenBytes;
    PlainLine line(cursor_.data(), cursor_.data() + limit, zero_);
    if (!read(line) || !line.end()) return false;
    cursor_.advance(static_cast<std::size_t>(line.next() - cursor_.data()));
    ++line_;
    line_begin_ = cursor_.offset();
    return true;
  }
  bool at_end() { return cursor_.at_end(); }

  // Returns the token at the cursor and moves past it; empty at the end of the line. Valid until the next call. THROWS:
  // Error{kBadInput} if it is longer than kTokenBytes.
  std::string_view token();

  // The next number of the line, of the type that the format prescribes.
  // THROWS: Error{kBadInput} with its position if it is missing or not a finite number; `what` names it ("coordinate").
  template <class Float>
  Float finite_number(const char* what);
  // The same for a number that may also be "nan" or "inf".
  template <class Float>
  Float any_number(const char* what);
  // From now on, -0 is delivered as -0.0; else as 0.0.
  void keep_signed_zeros() { zero_ = -0.0; }
  // The same for an integer. The whole token must be one.
  std::int64_t integer(const char* what);
  // Reads the digits at the cursor, without a sign; blanks are not skipped. If there are none or more than 18, returns
  // false and does not move.
  bool digits(std::uint64_t& value);

  // The error where digits() failed: there is no number, or one that is too large. `what` names it ("vertex index").
  [[noreturn]] void fail_digits(const char* what, const std::string& hint);

  char peek() { return cursor_.ensure(1) ? *cursor_.data() : '\n'; }
  void advance() { cursor_.advance(1); }

  // The start of the token read last, as "line:column".
  std::string position() const;
  // The error at position().
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const;
  // The next fail() reports the current position.
  void mark() {
    marked_line_ = line_;
    marked_column_ = cursor_.offset() - line_begin_ + 1;
  }

  std::uint64_t line() const { return line_; }
  // Moves to the beginning of a line. REQUIRES: source().can_seek(), or the line is not before the cursor.
  void move_to_line(std::uint64_t offset, std::uint64_t line) {
    cursor_.move_forward(offset);
    line_ = line;
    line_begin_ = offset;
  }
  const ContentSource& source() const { return cursor_.source(); }
  std::uint64_t bytes_read() const { return cursor_.bytes_read(); }
  Cursor& bytes() { return cursor_; }

 private:
  void skip_byte_order_mark();
  void skip_blanks();
  bool skip_continuation();
  void pass_newline() {
    cursor_.advance(1);
    ++line_;
    line_begin_ = cursor_.offset();
  }
  template <class Float>
  Float slow_number(const char* what);
  [[noreturn]] void fail_at_end(const char* what);
  [[noreturn]] void fail_number(std::string_view token, const char* what) const;

  Cursor cursor_;
  TextStyle style_;
  double zero_ = 0.0;  // is added to each number
  std::uint64_t line_ = 1, line_begin_ = 0;
  std::uint64_t marked_line_ = 1, marked_column_ = 1;
};

inline void TextCursor::skip_blanks() {
  while (cursor_.ensure(1)) {
    const char c = *cursor_.data();
    if (is_blank(c))
      cursor_.advance(1);
    else if (c != '\\' || !style_.continuation || !skip_continuation())
      return;
  }
}

inline bool TextCursor::digits(std::uint64_t& value) {
  cursor_.ensure(32);
  const char* const begin = cursor_.data();
  const std::size_t limit = cursor_.available() < 19 ? cursor_.available() : 19;
  std::uint64_t result = 0;
  std::size_t i = 0;
  for (; i < limit; ++i) {
    const unsigned digit = static_cast<unsigned char>(begin[i]) - unsigned{'0'};
    if (digit > 9) break;
    result = result * 10 + digit;
  }
  if (i == 0 || i == 19) return false;
  value = result;
  cursor_.advance(i);
  return true;
}

}  // namespace reeb::io
