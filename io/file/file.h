// A file by its descriptor: whole reads and writes at a place, and errors that say what to do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace reeb::io {

// Whether `path` names a file whose bytes lie on a disk: not a pipe, a folder or nothing.
bool is_regular_file(const std::string& path);

// A new file without a name in `folder`, open for reading and writing: gone when it is closed, however
// that comes about. -1 and errno if there can be none.
int open_unnamed(const std::string& folder) noexcept;

// Returns once the names in `folder` have reached the device. Not every file system can do that, which
// is no error.
void sync_folder(const std::string& folder) noexcept;

// Asked before each write for an errno to fail it with (0: none), so that tests can let the n-th
// write of a run fail as a full disk would.
using WriteFault = std::function<int(std::uint64_t offset, std::size_t bytes)>;

// Move-only owner of an open file; closing is the destructor's. Reads and writes name their
// place, are whole or throw, and go on after signals.
//
// THROWS: Error{kResource} with file, byte offset and what is needed (a full disk, a quota, a
//         device that fails); reading past the end is such an error, too.
// THREADS: any number may read and write at places that do not overlap.
class File {
 public:
  File() = default;
  // Takes over `descriptor`. `path` names the file in messages, even if it was unlinked.
  File(int descriptor, std::string path, std::shared_ptr<const WriteFault> fault = nullptr);
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  ~File();

  // THROWS: Error{kBadInput} if it cannot be opened.
  static File open_for_reading(const std::string& path);
  static File open_for_update(const std::string& path);
  // Creates `path`, or empties it.
  static File create(const std::string& path);

  bool is_open() const { return descriptor_ >= 0; }
  const std::string& path() const { return path_; }
  std::uint64_t size() const;

  void read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;
  // Returns once the content has reached the device.
  void sync() const;

 private:
  [[noreturn]] void fail(const char* doing, int error, std::uint64_t offset, std::size_t bytes) const;

  int descriptor_ = -1;
  std::string path_;
  std::shared_ptr<const WriteFault> fault_;
};

}  // namespace reeb::io
