#include "io/file/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::io {

OutputFile::OutputFile(int descriptor, std::string name)
    : descriptor_(descriptor), name_(std::move(name)), buffer_(std::make_unique_for_overwrite<char[]>(kBufferBytes)) {}

OutputFile::~OutputFile() { ::close(descriptor_); }

void OutputFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    if (filled_ == kBufferBytes) flush();
    const std::size_t part = std::min(bytes.size(), kBufferBytes - filled_);
    std::memcpy(buffer_.get() + filled_, bytes.data(), part);
    filled_ += part;
    bytes.remove_prefix(part);
  }
}

void OutputFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_output_error(errno, "write", name_, std::to_string(offset));
    offset += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::append_file(OutputFile& other) {
  other.flush();
  flush();
  for (std::uint64_t offset = 0; offset < other.flushed_;) {
    const ssize_t got = ::pread(other.descriptor_, buffer_.get(), kBufferBytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw_output_error(got < 0 ? errno : EIO, "read back", other.name_);
    filled_ = static_cast<std::size_t>(got);
    offset += filled_;
    flush();
  }
}

void OutputFile::flush() { write_out(buffer_.get(), std::exchange(filled_, 0)); }

void OutputFile::write_out(const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, data, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_output_error(errno, "write", name_, std::to_string(flushed_));
    data += written;
    bytes -= static_cast<std::size_t>(written);
    flushed_ += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::sync() {
  flush();
  // Pipes and terminals have nothing to wait for.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) throw_output_error(errno, "write", name_);
}

int open_nameless_file(const std::string& sibling) {
  const std::string name = sibling + ".part-" + std::to_string(::getpid());
  ::unlink(name.c_str());  // a leftover of a process that had this number
  const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) throw_output_error(errno, "create a temporary file for", sibling);
  ::unlink(name.c_str());
  return descriptor;
}

void throw_output_error(int code, const std::string& what, const std::string& name, const std::string& position) {
  const bool full = code == ENOSPC || code == EDQUOT;
  throw Error(ErrorKind::kResource,
              "cannot " + what + " the output: " + (full ? "the disk is full" : std::generic_category().message(code)),
              full ? "free space on this volume, or write to another one"
                   : "write to a folder that exists and that you may write to")
      .at(name, position);
}

}  // namespace reeb::io
