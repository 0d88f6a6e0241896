// Words, numbers and sections of a MSH file, text or binary.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "io/file/content_source.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"

namespace reeb::io {

// Known from the section $MeshFormat, which is always text.
struct MshFormat {
  bool version4 = false;  // 4.1, else 2.2
  bool binary = false, big_endian = false;
};

class MshItems {
 public:
  // Reads $MeshFormat. THROWS: Error{kBadInput}: another version, or damaged.
  explicit MshItems(std::unique_ptr<ContentSource> source);

  const MshFormat& format() const { return format_; }
  const ContentSource& source() const { return text_.source(); }
  std::uint64_t bytes_read() const { return text_.bytes_read(); }

  // The name of the next section, without the $; empty at the end of the file. Reads on after the line.
  std::string next_section();
  // Reads the line that ends the section. THROWS: Error{kBadInput} if something else is here.
  void end_section(const std::string& name);
  void skip_section(const std::string& name);

  // A number: an int or a size, a coordinate or value.
  std::int64_t integer(const char* what);
  std::uint64_t size(const char* what);
  double real(const char* what);
  // Text in files of both kinds: a line of a number, a line of a quoted string.
  std::uint64_t text_number(const char* what);
  std::string quoted_line();

  // Where the next item is, and a move to one. REQUIRES for the latter: the content can seek, or the item is not before
  // the next one.
  std::uint64_t here();
  void move_to(std::uint64_t offset, std::uint64_t line);
  std::uint64_t line() const { return text_.line(); }

  // The error at the item that was read last.
  [[noreturn]] void fail(const std::string& what, const std::string& hint = kDamagedHereHint) const;

 private:
  const char* take(std::size_t bytes, const char* what);
  void read_format();

  TextCursor text_;
  MshFormat format_;
  std::uint64_t offset_ = 0;  // of the item that was read last, in binary
};

}  // namespace reeb::io
