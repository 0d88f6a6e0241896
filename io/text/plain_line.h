// A line of numbers, read at once from the bytes ahead.
//
// Lines that are not plain (with a word, a sign before an integer, a comment, a continuation, a number out of range)
// are left to TextCursor, which reads them word by word and finds the position of what is wrong. Each call returns
// false if the line is not plain there.
#pragma once

#include <fast_float/fast_float.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <system_error>

namespace reeb::io {

class PlainLine {
 public:
  // `zero` is added to each number: 0.0 makes 0.0 of -0.0, and -0.0 changes nothing.
  PlainLine(const char* begin, const char* end, double zero) : next_(begin), end_(end), zero_(zero) {}

  // A word of this one letter.
  bool letter(char letter) {
    if (next_ == end_ || *next_ != letter) return false;
    ++next_;
    return at_separator();
  }

  // An integer of at most 19 digits, which fit, without a sign.
  bool integer(std::uint64_t& value) { return digits(value) && at_separator(); }

  // The same, and other numbers after slashes, which are skipped: a corner of an OBJ file.
  bool corner(std::uint64_t& value) {
    if (!digits(value)) return false;
    if (next_ != end_ && *next_ == '/')
      while (next_ != end_ && (*next_ == '/' || (*next_ >= '0' && *next_ <= '9'))) ++next_;
    return at_separator();
  }

  // A finite number.
  template <class Float>
  bool number(Float& value) {
    skip_blanks();
    const auto parsed = fast_float::from_chars(next_, end_, value);
    next_ = parsed.ptr;
    value += static_cast<Float>(zero_);
    return parsed.ec == std::errc{} && at_separator() && std::isfinite(value);
  }

  bool point(std::array<double, 3>& point) { return number(point[0]) && number(point[1]) && number(point[2]); }

  // A triangle with corners below `limit`, as "3 0 1 2".
  bool triangle(std::uint64_t limit, std::array<std::uint64_t, 3>& corners) {
    std::uint64_t length = 0;
    if (!integer(length) || length != 3) return false;
    for (std::uint64_t& corner : corners)
      if (!integer(corner) || corner >= limit) return false;
    return true;
  }

  // Whether more is on the line.
  bool more() {
    skip_blanks();
    return next_ != end_ && *next_ != '\n';
  }

  // Moves past the end of the line, if nothing is left on it.
  bool end() {
    skip_blanks();
    if (next_ == end_ || *next_ != '\n') return false;
    ++next_;
    return true;
  }

  const char* next() const { return next_; }

 private:
  bool digits(std::uint64_t& value) {
    skip_blanks();
    const char* const begin = next_;
    const char* const limit = end_ - begin > 19 ? begin + 19 : end_;
    std::uint64_t result = 0;
    for (; next_ != limit; ++next_) {
      const unsigned digit = static_cast<unsigned char>(*next_) - unsigned{'0'};
      if (digit > 9) break;
      result = result * 10 + digit;
    }
    value = result;
    return next_ != begin;
  }

  void skip_blanks() {
    while (next_ != end_ && (*next_ == ' ' || *next_ == '\t' || *next_ == '\r')) ++next_;
  }
  bool at_separator() const {
    return next_ != end_ && (*next_ == ' ' || *next_ == '\n' || *next_ == '\r' || *next_ == '\t');
  }

  const char* next_;
  const char* end_;
  double zero_;
};

}  // namespace reeb::io
