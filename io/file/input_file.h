// A regular file that is read: what can be said about it before its first byte, and the file opened once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/file/file.h"

namespace reeb::io {

// THROWS: Error{kBadInput} with a hint: absent, a directory, or not readable by this user.
void check_input_file(const std::string& path);

[[noreturn]] void throw_empty(const std::string& path);

// An open file that any number of readers map, so that all of them see the same file, whatever happens to
// its name. THREADS: any.
class MappableFile {
 public:
  // THROWS: Error{kBadInput}: absent, a directory or another special file, unreadable, empty.
  explicit MappableFile(const std::string& path);

  const std::string& path() const { return file_.path(); }
  std::uint64_t size() const { return size_; }
  // As File::map.
  Mapping map(std::uint64_t offset, std::size_t bytes) const { return file_.map(offset, bytes); }

 private:
  File file_;
  std::uint64_t size_ = 0;
};

}  // namespace reeb::io
