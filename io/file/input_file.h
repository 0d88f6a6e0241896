// A regular file that is read: what can be said about it before its first byte, and the file opened once.
#pragma once

#include <boost/interprocess/file_mapping.hpp>
#include <cstdint>
#include <string>

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

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  const boost::interprocess::file_mapping& mapping() const { return mapping_; }

 private:
  std::string path_;
  std::uint64_t size_ = 0;
  boost::interprocess::file_mapping mapping_;
};

}  // namespace reeb::io
