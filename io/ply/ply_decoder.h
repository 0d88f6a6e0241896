// The two forms of values in a PLY body, text and binary. A reader reads one value after the other, in the order of the
// header. Errors have the position of the value.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "io/mesh/scalar_bytes.h"
#include "io/ply/ply_header.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"

namespace reeb::io {

// Usually one record a line. A record may also run over several lines; what follows it on its last line is ignored, and
// counted.
class AsciiPlyDecoder {
 public:
  static constexpr bool kBinary = false;

  AsciiPlyDecoder(TextCursor text, const PlyHeader& header)
      : text_(std::move(text)), body_(header.body_offset), body_line_(text_.line()) {}

  void keep_signed_zeros() { text_.keep_signed_zeros(); }

  void begin_record(const PlyElement& element) {
    if (text_.more()) return;
    text_.mark();
    text_.fail("the file ends inside the element " + element.name, kCutHint);
  }
  void end_record(const PlyElement&) {
    for (; text_.more_on_line(); ++surplus_values_) text_.token();
    text_.skip_line();
  }
  // Values after the end of a record.
  std::uint64_t surplus_values() const { return surplus_values_; }
  bool has_more() { return text_.more(); }

  // Reads a triangle that is alone on its line ("3 0 1 2"), with corners below `limit`. If the line has another form or
  // is wrong, returns false and does not move.
  bool plain_triangle(std::uint64_t limit, std::array<std::uint64_t, 3>& corners) {
    return text_.plain_line([&](PlainLine& line) { return line.triangle(limit, corners); });
  }
  // The same for a record of finite values, one a property. REQUIRES: the element has no lists.
  bool plain_values(const PlyElement& element, std::span<double> values) {
    return text_.plain_line([&](PlainLine& line) {
      for (std::size_t p = 0; p < values.size(); ++p)
        if (!plain_value(line, element.properties[p].type, values[p])) return false;
      return true;
    });
  }

  double finite_value(ScalarType type, const char* what) {
    text_.require_more(what);
    if (type == ScalarType::kFloat32) return static_cast<double>(text_.finite_number<float>(what));
    if (type == ScalarType::kFloat64) return text_.finite_number<double>(what);
    return static_cast<double>(checked_integer(type, what));
  }
  // Perhaps not finite.
  double any_value(ScalarType type, const char* what) {
    if (!is_float(type)) return finite_value(type, what);
    text_.require_more(what);
    return type == ScalarType::kFloat32 ? static_cast<double>(text_.any_number<float>(what))
                                        : text_.any_number<double>(what);
  }
  std::int64_t integer(ScalarType type, const char* what) {
    text_.require_more(what);
    text_.mark();
    std::uint64_t value = 0;
    const char first = text_.peek();
    if (first < '0' || first > '9' || !text_.digits(value)) return checked_integer(type, what);
    if (const char next = text_.peek(); next != '\n' && !is_blank(next))
      text_.fail(std::string("a ") + what + " is not an integer", kDamagedHereHint);
    return within(type, static_cast<std::int64_t>(value), what);
  }
  // Returns true if the skipped value is not finite.
  bool skip(ScalarType, const char* what) {
    text_.require_more(what);
    return spells_non_finite(text_.token());
  }
  void move_to_body() { text_.move_to_line(body_, body_line_); }
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const { text_.fail(what, hint); }

  const ContentSource& source() const { return text_.source(); }
  std::uint64_t bytes_read() const { return text_.bytes_read(); }
  Cursor& bytes() { return text_.bytes(); }

 private:
  std::int64_t checked_integer(ScalarType type, const char* what) { return within(type, text_.integer(what), what); }

  // False if it is not plain; also for an integer that does not fit its type.
  static bool plain_value(PlainLine& line, ScalarType type, double& value) {
    if (type == ScalarType::kFloat64) return line.number(value);
    if (type == ScalarType::kFloat32) {
      float single = 0;
      if (!line.number(single)) return false;
      value = static_cast<double>(single);
      return true;
    }
    std::uint64_t integer = 0;
    if (!line.integer(integer) || integer > largest_value(type)) return false;
    value = static_cast<double>(integer);
    return true;
  }

  std::int64_t within(ScalarType type, std::int64_t value, const char* what) const {
    const bool is_signed = type == ScalarType::kInt8 || type == ScalarType::kInt16 || type == ScalarType::kInt32;
    const auto most = static_cast<std::int64_t>(largest_value(type));
    const std::int64_t least = is_signed ? -most - 1 : 0;
    if (value < least || value > most)
      text_.fail("the " + std::string(what) + " " + std::to_string(value) + " does not fit its declared type",
                 kDamagedHereHint);
    return value;
  }

  TextCursor text_;
  std::uint64_t body_, body_line_;
  std::uint64_t surplus_values_ = 0;
};

// Records without separators.
class BinaryPlyDecoder {
 public:
  static constexpr bool kBinary = true;

  BinaryPlyDecoder(TextCursor text, const PlyHeader& header)
      : cursor_(std::move(text.bytes())),
        body_(header.body_offset),
        swap_(header.encoding == PlyEncoding::kBigEndian) {}

  void keep_signed_zeros() { zero_ = -0.0; }

  void begin_record(const PlyElement&) {}
  void end_record(const PlyElement&) {}
  std::uint64_t surplus_values() const { return 0; }
  bool has_more() { return !cursor_.at_end(); }
  double finite_value(ScalarType type, const char* what) {
    const double value = any_value(type, what);
    if (!std::isfinite(value)) fail(std::string("a ") + what + " is not finite", "fix this value in the file");
    return value;
  }
  double any_value(ScalarType type, const char*) { return load_double(type, take(byte_size(type)), swap_, zero_); }
  std::int64_t integer(ScalarType type, const char*) { return load_integer(type, take(byte_size(type)), swap_); }
  bool skip(ScalarType type, const char*) {
    const char* const bytes = take(byte_size(type));
    return is_float(type) && !std::isfinite(load_double(type, bytes, swap_));
  }
  void move_to_body() { cursor_.move_to(body_); }

  // Fails at the value read last.
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const { fail_at(taken_, what, hint); }
  [[noreturn]] void fail_at(std::uint64_t offset, const std::string& what, const std::string& hint) const {
    throw Error(ErrorKind::kBadInput, what, hint).at(source().name(), std::to_string(offset));
  }

  const ContentSource& source() const { return cursor_.source(); }
  std::uint64_t bytes_read() const { return cursor_.bytes_read(); }
  Cursor& bytes() { return cursor_; }
  std::uint64_t offset() const { return cursor_.offset(); }
  bool swaps() const { return swap_; }

  // The next `size` bytes. THROWS: Error{kBadInput} if the file ends before.
  const char* take(std::size_t size) {
    taken_ = cursor_.offset();
    if (!cursor_.ensure(size)) [[unlikely]]
      fail_at(cursor_.offset() + cursor_.available(), "the file ends before its last element", kCutHint);
    const char* const bytes = cursor_.data();
    cursor_.advance(size);
    return bytes;
  }

 private:
  Cursor cursor_;
  std::uint64_t body_;
  std::uint64_t taken_ = 0;
  bool swap_;
  double zero_ = 0.0;  // is added to each number
};

}  // namespace reeb::io
