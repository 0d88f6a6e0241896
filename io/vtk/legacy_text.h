// Words, lines and arrays of a legacy VTK file, text or binary.
#pragma once

#include <cstdint>
#include <string>

#include "io/text/cursor.h"
#include "io/text/hints.h"

namespace reeb::io {

// THROWS, from all members: Error{kBadInput} with the place of the word or line that was read last.
class LegacyText {
 public:
  // `content` must outlive this.
  explicit LegacyText(const ContentSource& content) : content_(content), cursor_(content.reopen()) {}

  // As the third line says. Until then it is text.
  void set_binary() { binary_ = true; }
  bool is_binary() const { return binary_; }
  // Where the next byte is.
  std::uint64_t offset() const { return cursor_.offset(); }
  bool at_end() { return cursor_.at_end(); }

  // The next word, across line ends; empty at the end of the file.
  std::string word();
  // The next word as a count; `what` names it.
  std::uint64_t number(const char* what);
  // The word at the cursor, if it can be a keyword, in capitals; does not move.
  std::string peek_word();
  bool more_on_line();
  // Moves past the end of this line.
  void end_line();
  // The same, and returns the rest of the line, as far as messages and checks need it.
  std::string line();

  // The values of arrays. THROWS: also if the file ends before.
  void skip_bytes(std::uint64_t count);
  void skip_words(std::uint64_t count);
  void skip_strings(std::uint64_t count);
  // a * b. THROWS: if no file has so many numbers.
  std::uint64_t product(std::uint64_t a, std::uint64_t b) const;

  [[noreturn]] void fail(const std::string& what, const std::string& hint = kCutOrDamagedHereHint) const;

 private:
  [[noreturn]] void fail_end();

  const ContentSource& content_;
  Cursor cursor_;
  std::uint64_t mark_ = 0;  // the word or line that was read last
  bool binary_ = false;
};

}  // namespace reeb::io
