// A file being written: a descriptor with a large buffer, and errors that say what to do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace reeb::io {

// Bytes are handed to the system in pieces of kBufferBytes, so small records cost a copy only.
// Every failure throws Error{kResource} that names the file and the offset. The destructor closes
// without flushing: what was not flushed was not wanted.
class OutputFile {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

  // Takes over an open descriptor. `name` stands in error texts.
  OutputFile(int descriptor, std::string name);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  void append(std::string_view bytes);
  // Room for a record of at most `bytes` bytes, to be filled in place; commit_record() then takes
  // the first `used` of them. REQUIRES: bytes <= kBufferBytes.
  char* reserve_record(std::size_t bytes) {
    if (bytes > kBufferBytes - filled_) flush();
    return buffer_.get() + filled_;
  }
  void commit_record(std::size_t used) { filled_ += used; }

  // Overwrites bytes that were appended before. Flushes.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  // Appends the whole content of `other`, in bounded memory. Flushes both.
  void append_file(OutputFile& other);

  void flush();
  // Flushes and waits until the bytes are on the device, as far as the file is on one.
  void sync();

  std::uint64_t size() const { return flushed_ + filled_; }
  const std::string& name() const { return name_; }

 private:
  void write_out(const char* data, std::size_t bytes);

  int descriptor_;
  std::string name_;
  std::unique_ptr<char[]> buffer_;
  std::size_t filled_ = 0;
  std::uint64_t flushed_ = 0;
};

// Opens a file that has no name, in the folder of `sibling`: it vanishes with its descriptor.
// THROWS: Error{kResource} where the folder cannot be written.
int open_nameless_file(const std::string& sibling);

// Throws Error{kResource} for the system's error number `code`, met while doing `what` ("write").
[[noreturn]] void throw_output_error(int code, const std::string& what, const std::string& name,
                                     const std::string& position = {});

}  // namespace reeb::io
