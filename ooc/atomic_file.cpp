#include "ooc/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

using Traits = std::char_traits<char>;

constexpr std::size_t kTextBufferBytes = 1 << 16;

bool is_folder(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

}  // namespace

std::string folder_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  if (is_folder(path_)) {
    errno = EISDIR;
    fail("cannot be written");
  }
  for (unsigned attempt = 0; fd_ < 0; ++attempt) {
    temporary_ = path_ + ".partial-" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno != EEXIST) fail("cannot be written");
  }
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::append(std::span<const std::byte> bytes) {
  write_fully(size_, bytes);
  size_ += bytes.size();
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  write_fully(offset, bytes);
}

void AtomicFile::commit() {
  if (::fsync(fd_) != 0) fail("cannot be written to disk");
  if (::close(std::exchange(fd_, -1)) != 0) fail("cannot be written to disk");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be renamed into place");
  temporary_.clear();
  // Not every file system lets a folder be synchronized; the file itself is whole either way.
  const int folder = ::open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void AtomicFile::write_fully(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void AtomicFile::fail(const char* action) const {
  const int code = errno;
  const bool full = code == ENOSPC || code == EDQUOT || code == EFBIG;
  throw Error(ErrorKind::kResource, std::string(action) + ": " + std::strerror(code),
              full ? "make room on the disk, or write to another folder"
                   : "write to a folder that exists and that you may write to")
      .at(path_);
}

void AtomicFile::discard() noexcept {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

AtomicOutput::AtomicOutput(std::string path)
    : std::ostream(nullptr), file_(std::move(path)), buffer_(kTextBufferBytes) {
  setp(buffer_.data(), buffer_.data() + buffer_.size());
  rdbuf(this);
  exceptions(std::ios::badbit);
}

AtomicOutput::~AtomicOutput() = default;

void AtomicOutput::commit() {
  sync();
  file_.commit();
}

std::streambuf::int_type AtomicOutput::overflow(std::streambuf::int_type c) {
  sync();
  if (Traits::eq_int_type(c, Traits::eof())) return Traits::not_eof(c);
  *pptr() = Traits::to_char_type(c);
  pbump(1);
  return c;
}

int AtomicOutput::sync() {
  file_.append(std::as_bytes(std::span(pbase(), pptr())));
  setp(buffer_.data(), buffer_.data() + buffer_.size());
  return 0;
}

}  // namespace reeb::ooc
