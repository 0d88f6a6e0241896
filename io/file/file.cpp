#include "io/file/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::io {

bool is_regular_file(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

int open_unnamed(const std::string& folder) noexcept {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Not every file system has files without a name.
  std::string name = folder + "/reeb-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

void sync_folder(const std::string& folder) noexcept {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

File::File(int descriptor, std::string path, std::shared_ptr<const WriteFault> fault)
    : descriptor_(descriptor), path_(std::move(path)), fault_(std::move(fault)) {}

File::File(File&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      fault_(std::move(other.fault_)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  std::swap(fault_, other.fault_);
  return *this;
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

namespace {

File open_existing(const std::string& path, int access) {
  const int descriptor = ::open(path.c_str(), access | O_CLOEXEC);
  if (descriptor < 0)
    throw Error(ErrorKind::kBadInput, std::string("cannot be opened: ") + std::strerror(errno),
                "check the name and the permissions")
        .at(path);
  return {descriptor, path};
}

}  // namespace

File File::open_for_reading(const std::string& path) { return open_existing(path, O_RDONLY); }

File File::open_for_update(const std::string& path) { return open_existing(path, O_RDWR); }

File File::create(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0)
    throw Error(ErrorKind::kResource, std::string("cannot be created: ") + std::strerror(errno),
                "choose a folder that exists and can be written")
        .at(path);
  return {descriptor, path};
}

std::uint64_t File::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail("ask the size of", errno, 0, 0);
  return static_cast<std::uint64_t>(status.st_size);
}

void File::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t done = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("read", done < 0 ? errno : 0, offset, bytes.size());
    offset += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void File::write_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
  if (fault_ != nullptr && *fault_)
    if (const int error = (*fault_)(offset, bytes.size()); error != 0) fail("write", error, offset, bytes.size());
  while (!bytes.empty()) {
    const ssize_t done = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("write", done < 0 ? errno : ENOSPC, offset, bytes.size());
    offset += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void File::sync() const {
  while (::fsync(descriptor_) != 0)
    if (errno != EINTR) fail("flush", errno, 0, 0);
}

void File::fail(const char* doing, int error, std::uint64_t offset, std::size_t bytes) const {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  std::string what = std::string("cannot ") + doing + " " + format_bytes(bytes) + ": ";
  what += error == 0 ? "the file ends before" : std::strerror(error);
  const std::string hint = full ? "free at least " + format_bytes(offset + bytes) +
                                      " more on this volume, or choose another with --temp-dir DIR"
                                : "check the disk, or choose another with --temp-dir DIR";
  throw Error(ErrorKind::kResource, what, hint).at(path_, std::to_string(offset));
}

}  // namespace reeb::io
