#include "io/file/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/file/file.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;
using Traits = std::char_traits<char>;

constexpr std::size_t kTextBufferBytes = 1 << 16;

bool is_folder(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

// PATH.partial-PID-N
constexpr const char* kSuffix = ".partial-";

bool is_number_pair(std::string_view text) {
  const auto dash = text.find('-');
  const auto is_number = [](std::string_view t) {
    return !t.empty() && t.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && is_number(text.substr(0, dash)) && is_number(text.substr(dash + 1));
}

}  // namespace

std::string folder_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

void require_output_folder(const std::string& path) {
  const std::string folder = folder_of(path);
  const int probe = open_unnamed(folder);
  if (probe < 0)
    throw Error(ErrorKind::kResource,
                std::string("the output cannot be written to this folder: ") + std::strerror(errno),
                "write to a folder that exists and that you may write to with -o FILE")
        .at(folder);
  ::close(probe);
}

void remove_abandoned(const std::string& path) noexcept {
  const std::string prefix = fs::path(path).filename().string() + kSuffix;
  std::error_code error;
  for (fs::directory_iterator entry(folder_of(path), error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix) || !is_number_pair(std::string_view(name).substr(prefix.size()))) continue;
    const int file = ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    ::close(file);
  }
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  if (is_folder(path_)) {
    errno = EISDIR;
    fail("cannot be written");
  }
  remove_abandoned(path_);
  for (unsigned attempt = 0; fd_ < 0; ++attempt) {
    temporary_ = path_ + kSuffix + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno != EEXIST) fail("cannot be written");
  }
  ::flock(fd_, LOCK_EX | LOCK_NB);  // for remove_abandoned()
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::append(std::span<const std::byte> bytes) {
  write_fully(size_, bytes);
  size_ += bytes.size();
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) { write_fully(offset, bytes); }

void AtomicFile::commit() {
  while (::fsync(fd_) != 0)
    if (errno != EINTR) fail("cannot be written to disk");
  ::close(std::exchange(fd_, -1));  // all of it is on the device by now
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be renamed into place");
  temporary_.clear();
  sync_folder(folder_of(path_));
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

}  // namespace reeb::io
