// The lines and words of a text header, which is in the first view of the content.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/content_source.h"

namespace reeb::io {

std::string_view without_blanks(std::string_view text);
std::vector<std::string_view> split_words(std::string_view text);

class HeaderText {
 public:
  // Longer headers are not read.
  static constexpr std::size_t kMostBytes = ContentSource::kLookahead;

  // `name` is that of the file, for messages. `head` must stay valid.
  HeaderText(std::string_view head, std::string name) : head_(head.substr(0, kMostBytes)), name_(std::move(name)) {}

  // Moves to the next line; false at the end of `head`.
  bool next_line();
  // The line without its end (LF or CR LF).
  std::string_view line() const { return line_; }
  std::uint64_t line_number() const { return number_; }
  // Where the next line begins, as an offset in `head`.
  std::size_t offset() const { return next_; }

  // These words of the line as numbers; `what` names one ("spacing").
  // THROWS: Error{kBadInput} with line and column.
  double number(std::string_view word, const char* what) const;  // finite
  std::int64_t integer(std::string_view word, const char* what) const;
  std::uint64_t count(std::string_view word, const char* what) const;  // not negative

  // The error at a part of the line.
  [[noreturn]] void fail(std::string_view part, const std::string& what, const std::string& hint) const;
  // The error at the line.
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const { fail(line_, what, hint); }

 private:
  std::string_view head_, line_;
  std::string name_;
  std::size_t next_ = 0;
  std::uint64_t number_ = 0;
};

}  // namespace reeb::io
