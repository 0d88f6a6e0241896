// A file by its descriptor: whole reads and writes at a place, and errors that say what to do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reeb::io {

// Whether `path` names a file whose bytes lie on a disk: not a pipe, a folder or nothing.
bool is_regular_file(const std::string& path);
// Whether `path` names a device, a FIFO or a socket: something that is written into, not replaced.
bool is_device(const std::string& path);

// The folder that holds `path`.
std::string folder_of(const std::string& path);

// Returns once the names in `folder` have reached the device, as far as the file system can tell.
// THROWS: Error{kResource}.
void sync_folder(const std::string& folder);

// Part of a file in the address space, for reading; the destructor gives it back.
class Mapping {
 public:
  Mapping() = default;
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  ~Mapping();

  std::span<const std::byte> bytes() const { return bytes_; }
  // Pages around one that is touched are not read.
  void expect_random_access() const noexcept;
  // Gives the pages that were touched back to the system; they are read again when needed.
  void release_pages() const noexcept;

 private:
  friend class File;
  std::span<const std::byte> bytes_;
};

// Move-only owner of an open file; closing is the destructor's. Reads and writes name their
// place, are whole or throw, and go on after signals.
//
// THROWS: Error with file and byte offset. Of an input: kBadInput, also where it ends before. Of other files:
//         kResource with what is needed (a full disk, a quota, a device that fails).
// THREADS: any number may read and write at places that do not overlap.
class File {
 public:
  enum class Use { kInput, kTemporary, kOutput };  // what errors say and advise

  File() = default;
  // Takes over `descriptor`. `path` names the file in messages, even if it was unlinked.
  File(int descriptor, std::string path, Use use);
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  ~File();

  // An input. THROWS: Error{kBadInput} if it is missing, cannot be read, or is not a regular file.
  static File open_for_reading(const std::string& path);
  // A file that this program made. THROWS: Error{kBadInput} if it cannot be opened, or is a link.
  static File open_for_update(const std::string& path);
  // A new file of this program, for this user only. A file that had its name before is removed; anything else is left
  // alone. THROWS: Error{kResource}.
  static File create(const std::string& path);

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }
  std::uint64_t size() const;

  void read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;
  // Where the descriptor stands, which is `offset` in messages: pipes know no other place.
  void write_next(std::uint64_t offset, std::span<const std::byte> bytes) const;
  // REQUIRES: offset is a multiple of the page size; the file has the bytes, of which there are some.
  Mapping map(std::uint64_t offset, std::size_t bytes) const;
  // Returns once the content has reached the device.
  void sync() const;

  // Throws the Error for the system's error number `error`, met while `doing` ("write").
  [[noreturn]] void fail(const char* doing, int error, std::uint64_t offset, std::size_t bytes) const;

 private:
  int descriptor_ = -1;
  std::string path_;
  Use use_ = Use::kTemporary;
};

// Throws Error{kResource}: the output `path` cannot be written, for the system's error number `error`.
[[noreturn]] void throw_output_error(int error, const std::string& path, const std::string& position = {});

}  // namespace reeb::io
