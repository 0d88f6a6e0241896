// An input that is a regular file: checks before the first byte is read, and the file opened once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/file/file.h"

namespace reeb::io {

// THROWS: Error{kBadInput} with a hint if it is missing, a directory, or not readable by this user.
void check_input_file(const std::string& path);

[[noreturn]] void throw_empty(const std::string& path);

// An open file that any number of readers can map. All of them see the same file, even if its name is removed or
// replaced.
// THREADS: any.
class MappableFile {
 public:
  // THROWS: Error{kBadInput} if it is missing, a directory or another special file, unreadable, or empty.
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
