#include "io/file/file_ostream.h"

#include <algorithm>

namespace reeb::io {

FileOstream::FileOstream(BufferedWriter& file) : std::ostream(this), file_(file), at_(file.size()) {
  exceptions(std::ios::badbit | std::ios::failbit);
}

std::streamsize FileOstream::xsputn(const char* bytes, std::streamsize count) {
  const std::string_view all(bytes, static_cast<std::size_t>(count));
  const auto old = static_cast<std::size_t>(std::min<std::uint64_t>(file_.size() - at_, all.size()));
  if (old != 0) file_.overwrite(at_, all.substr(0, old));
  file_.append(all.substr(old));
  at_ += all.size();
  return count;
}

FileOstream::int_type FileOstream::overflow(int_type c) {
  if (Traits::eq_int_type(c, Traits::eof())) return Traits::not_eof(c);
  const char byte = Traits::to_char_type(c);
  xsputn(&byte, 1);
  return c;
}

FileOstream::pos_type FileOstream::seekoff(off_type offset, std::ios_base::seekdir direction,
                                           std::ios_base::openmode which) {
  off_type base = 0;
  if (direction == std::ios_base::cur) base = static_cast<off_type>(at_);
  if (direction == std::ios_base::end) base = static_cast<off_type>(file_.size());
  return seekpos(base + offset, which);
}

FileOstream::pos_type FileOstream::seekpos(pos_type position, std::ios_base::openmode /*which*/) {
  const auto offset = static_cast<off_type>(position);
  if (offset < 0 || static_cast<std::uint64_t>(offset) > file_.size()) return off_type{-1};
  at_ = static_cast<std::uint64_t>(offset);
  return position;
}

}  // namespace reeb::io
