// The bytes of an array in a file of VTK: as they are, or in base64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "io/file/content_source.h"
#include "io/text/cursor.h"

namespace reeb::io {

// Moves to an offset that is not before the cursor; on content that cannot seek, through everything before it.
void move_forward(Cursor& cursor, std::uint64_t offset);

class EncodedBytes {
 public:
  // The array begins at `offset`. REQUIRES: no view of `source` was taken beyond it, unless it can seek.
  EncodedBytes(std::unique_ptr<ContentSource> source, std::uint64_t offset, bool base64);

  // Reads at most `limit` bytes and returns their number; 0 only at the end: of the file, or of the base64 text.
  // THROWS: Error{kBadInput} at a base64 text that is damaged.
  std::size_t read(char* out, std::size_t limit);

  // Where the next byte is, for messages.
  std::uint64_t offset() const { return cursor_.offset(); }
  const ContentSource& source() const { return cursor_.source(); }
  std::uint64_t bytes_read() const { return cursor_.bytes_read(); }

 private:
  std::size_t read_raw(char* out, std::size_t limit);
  std::size_t decode();

  Cursor cursor_;
  bool base64_;
  char triple_[3] = {};  // decoded bytes that were not taken
  std::size_t triple_size_ = 0, triple_taken_ = 0;
};

}  // namespace reeb::io
