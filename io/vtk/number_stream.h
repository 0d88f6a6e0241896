// The numbers of an array in a file of VTK, one after the other, however they are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/decoding/byte_input.h"
#include "io/file/content_source.h"
#include "io/text/cursor.h"
#include "io/vtk/number_place.h"

namespace reeb::io {

// Where an array has no size of its own, its user must not read more numbers than it has: what follows may be numbers,
// too. Text ends at the next '<' or word.
class NumberStream {
 public:
  // Reads `content` independently of others. `what` names a number in messages ("coordinate").
  // REQUIRES: content.reopen() is not null; `content` outlives this.
  // THROWS: Error{kBadInput}: the file has no room for `count` numbers, or the header of the array is damaged.
  NumberStream(const ContentSource& content, const NumberPlace& place, std::uint64_t count, const char* what);

  // The next number, as the type of the array holds it; perhaps not finite. -0.0 becomes 0.0.
  // THROWS: Error{kBadInput} at the end, or where the text is not a number.
  double real();
  // The next number of an array of integers. THROWS: as real().
  std::int64_t integer();
  void skip(std::uint64_t count);

  // How many numbers of real() were integers that no double is equal to.
  std::uint64_t rounded() const { return rounded_; }

  // The error at the number that was read last.
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const;

  std::uint64_t bytes_read() const { return text_ ? text_->bytes_read() : bytes_->file_bytes_read(); }
  std::uint64_t memory_bytes() const { return bytes_ ? bytes_->memory_bytes() : 0; }

 private:
  std::string_view token();
  const char* item();
  void check_room(std::uint64_t count) const;
  [[noreturn]] void fail_token(std::string_view token) const;

  const ContentSource& content_;
  NumberPlace place_;
  const char* what_;
  std::optional<Cursor> text_;
  std::unique_ptr<ByteInput> bytes_;
  std::vector<char> buffer_;
  std::size_t item_bytes_ = 0, taken_ = 0;
  std::uint64_t rounded_ = 0;
  std::uint64_t item_offset_ = 0;  // of the number that was read last
};

}  // namespace reeb::io
