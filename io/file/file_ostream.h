// A std::ostream on a BufferedWriter, for writers that work on streams.
#pragma once

#include <ostream>
#include <streambuf>

#include "io/file/buffered_writer.h"

namespace reeb::io {

// Bytes are passed on at once, since the file has its own buffer. The position can be set back to overwrite bytes. The
// stream passes on errors of the file unchanged.
class FileOstream : private std::streambuf, public std::ostream {
 public:
  // `file` must outlive this.
  explicit FileOstream(BufferedWriter& file);

 private:
  using Traits = std::streambuf::traits_type;
  using int_type = Traits::int_type;
  using pos_type = Traits::pos_type;
  using off_type = Traits::off_type;

  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int_type overflow(int_type c) override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir direction, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override;

  BufferedWriter& file_;
  std::uint64_t at_;
};

}  // namespace reeb::io
