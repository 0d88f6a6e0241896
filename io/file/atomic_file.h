// A file that appears under its name only when it is whole.
//
// Bytes go to a temporary file in the same folder. commit() makes them durable and renames; without
// it the destructor removes them, and what had the name before is untouched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <streambuf>
#include <string>
#include <vector>

namespace reeb::io {

// The folder that holds `path`.
std::string folder_of(const std::string& path);

// THROWS: Error{kResource} that names the folder of `path` if no file can be made there.
void require_output_folder(const std::string& path);

// Removes the temporary files that killed writers of `path` left; a living writer holds a lock on its
// own. AtomicFile does so itself.
void remove_abandoned(const std::string& path) noexcept;

// THROWS, from every call: Error{kResource} with the path: the folder cannot be written, the disk is
// full.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void append(std::span<const std::byte> bytes);
  // Overwrites bytes that were appended before.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  std::uint64_t size() const { return size_; }

  // fsync, rename, fsync of the folder: after a power loss either the old file is there or the new.
  void commit();

 private:
  void write_fully(std::uint64_t offset, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* action) const;
  void discard() noexcept;

  std::string path_, temporary_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
};

// The same for writers of text: an output stream with a buffer in front of an AtomicFile. Errors of
// the file pass through the stream as they are (its exceptions are on).
class AtomicOutput : private std::streambuf, public std::ostream {
 public:
  explicit AtomicOutput(std::string path);
  ~AtomicOutput() override;
  void commit();

 private:
  std::streambuf::int_type overflow(std::streambuf::int_type c) override;
  int sync() override;

  AtomicFile file_;
  std::vector<char> buffer_;
};

}  // namespace reeb::io
