// An input that is a regular file: checks before the first byte is read, and the file opened once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io/file/file.h"

namespace reeb::io {

// THROWS: Error{kBadInput} with a hint if it is missing, a directory, or not readable by this user.
void check_input_file(const std::string& path);

[[noreturn]] void throw_empty(const std::string& path);

// Whether content without a byte is a legal one.
enum class Empty { kRefused, kAllowed };

// What changes when a file is written to, or replaced: its size, the times of its last changes (of the content; of
// anything), and which file it is.
struct FileState {
  std::uint64_t bytes = 0;
  std::int64_t modified_ns = 0, changed_ns = 0;
  std::uint64_t device = 0, inode = 0;
  std::uint64_t names = 0;  // links; adding or removing one is a change, though not of the content
};
FileState state_of(const File& file);

// An open file that any number of readers can read. All of them see the same file, even if its name is removed or
// replaced.
// THREADS: any.
class InputFile {
 public:
  // THROWS: Error{kBadInput} if it is missing, a directory or another special file, unreadable, or empty. A file that
  // is packed by its name is never allowed to be empty.
  explicit InputFile(const std::string& path, Empty empty = Empty::kRefused);
  // A file that is open, such as one without a name.
  explicit InputFile(File file);

  const std::string& path() const { return file_.path(); }
  std::uint64_t size() const { return state_.bytes; }
  Empty empty() const { return empty_; }  // what it may be, also when it is unpacked
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) const { file_.read_at(offset, bytes); }

  // What was read fits together only if this does not throw afterwards. `content` is for the message.
  // THROWS: Error{kChanged} if the file was written to since it was opened, or its name is that of another file now.
  void check_unchanged(const char* content) const;

 private:
  Empty empty_ = Empty::kRefused;
  File file_;
  FileState state_;
};

// The file `path`, if it is a regular one; else null ("-", a pipe).
// THROWS: as InputFile.
std::shared_ptr<const InputFile> open_if_regular(const std::string& path, Empty empty = Empty::kRefused);

}  // namespace reeb::io
