// A file written through a buffer. All outputs are written this way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "io/file/file.h"

namespace reeb::io {

// Bytes are passed to the system a full buffer at a time, so a small record costs only a copy. The destructor closes
// without flushing: an output that was not flushed was abandoned.
// THROWS: as File.
class BufferedWriter {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

  // REQUIRES: `file` is empty.
  explicit BufferedWriter(File file, std::size_t buffer_bytes = kBufferBytes);

  void append(std::span<const std::byte> bytes);
  void append(std::string_view text) { append(std::as_bytes(std::span(text))); }
  // Returns room for a record of at most `bytes` bytes, to be filled in place; commit_record() then takes the first
  // `used` of them. REQUIRES: `bytes` is at most the size of the buffer.
  char* reserve_record(std::size_t bytes) {
    if (bytes > buffer_bytes_ - filled_) flush();
    return buffer_.get() + filled_;
  }
  void commit_record(std::size_t used) { filled_ += used; }

  // Flushes, then overwrites bytes that were appended before. REQUIRES: a file, not a pipe.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  void overwrite(std::uint64_t offset, std::string_view text) { overwrite(offset, std::as_bytes(std::span(text))); }
  // Appends the whole content of `other`, in bounded memory. Flushes both.
  void append_file(BufferedWriter& other);

  void flush();
  // Flushes, and waits until the bytes are on the device, if the file is on one.
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
  std::uint64_t syncing_ = 0;  // up to here they are on their way to the device, if this is an output
};

}  // namespace reeb::io
