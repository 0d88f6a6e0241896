// Lines of a text file, and the numbers in a line, for SMA and SVA.
//
// Lines end with LF or CR LF; the last one may have no end. Blanks are spaces and tabs.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "io/text/cursor.h"

namespace reeb::io {

class LineScanner {
 public:
  static constexpr std::size_t kMaxLine = 65535;

  explicit LineScanner(Cursor& cursor) : cursor_(cursor) {}

  // The next line without its end, valid until the next call; nothing at the end of the file.
  // THROWS: UNSUPPORTED for control bytes, BAD_NUMBER for a line longer than kMaxLine.
  std::optional<std::string_view> next();
  // Makes next() return the last line again.
  void put_back() { put_back_ = true; }

  std::uint64_t number() const { return number_; }  // of the line last returned, from 1
  // The line last returned has no line end, so the file could be truncated there.
  bool unfinished() const { return unfinished_; }

 private:
  Cursor& cursor_;
  std::size_t length_ = 0;  // bytes of the last line, with its line end; the cursor is before them
  std::string_view line_;
  std::uint64_t number_ = 0;
  bool unfinished_ = false, put_back_ = false;
};

enum class NumberVerdict : std::uint8_t { kValid, kMissing, kNotANumber, kOutOfRange };

// Reads the numbers of one line from left to right.
class LineCursor {
 public:
  // `line` is a complete line; reading starts at its character `at`.
  LineCursor(std::string_view line, std::size_t at) : line_(line), at_(at), token_(at) {}

  bool at_end() {
    skip_blanks();
    return at_ == line_.size();
  }
  std::string_view word();  // up to the next blank, empty at the end
  // The float32 nearest to a decimal or hexadecimal number. Infinities, NaN and numbers beyond float32 are kOutOfRange;
  // underflow gives 0.
  NumberVerdict number(float& value);
  NumberVerdict number(std::int32_t& value);

  // The word that was read last, and its column from 1.
  std::string_view last_word() const;
  std::size_t column() const { return token_ + 1; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t'; }
  void skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
    token_ = at_;
  }

  std::string_view line_;
  std::size_t at_, token_;
};

}  // namespace reeb::io
