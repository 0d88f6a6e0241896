// A file written through a buffer: the one way in which outputs are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "io/file/file.h"

namespace reeb::io {

// Bytes are handed to the system in pieces of the buffer's size, so small records cost a copy only.
// The destructor closes without flushing: what was not flushed was not wanted.
// THROWS: as File.
class BufferedWriter {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

  // `file` is empty.
  explicit BufferedWriter(File file, std::size_t buffer_bytes = kBufferBytes);

  void append(std::span<const std::byte> bytes);
  void append(std::string_view text) { append(std::as_bytes(std::span(text))); }
  // Room for a record of at most `bytes` bytes, to be filled in place; commit_record() then takes
  // the first `used` of them. REQUIRES: bytes are at most the buffer's.
  char* reserve_record(std::size_t bytes) {
    if (bytes > buffer_bytes_ - filled_) flush();
    return buffer_.get() + filled_;
  }
  void commit_record(std::size_t used) { filled_ += used; }

  // Overwrites bytes that were appended before. Flushes. REQUIRES: a file, not a pipe.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  void overwrite(std::uint64_t offset, std::string_view text) { overwrite(offset, std::as_bytes(std::span(text))); }
  // Appends the whole content of `other`, in bounded memory. Flushes both.
  void append_file(BufferedWriter& other);

  void flush();
  // Flushes and waits until the bytes are on the device, as far as the file is on one.
  void sync();

  std::uint64_t size() const { return flushed_ + filled_; }
  const File& file() const { return file_; }

 private:
  void write_out(std::span<const std::byte> bytes);

  File file_;
  std::size_t buffer_bytes_;
  std::unique_ptr<char[]> buffer_;
  std::size_t filled_ = 0;
  std::uint64_t flushed_ = 0;
};

}  // namespace reeb::io
