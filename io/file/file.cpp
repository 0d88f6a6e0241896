#include "io/file/file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "io/file/system.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::io {
namespace {

bool is_full(int error) { return error == ENOSPC || error == EDQUOT; }

ErrorCause cause_of(int error) { return error == ENOMEM ? ErrorCause::kMemory : ErrorCause::kNone; }

[[noreturn]] void throw_unreadable(const std::string& why, const std::string& path, ErrorCause cause) {
  throw Error(ErrorKind::kBadInput, "cannot be read: " + why, "name a file that exists and may be read")
      .at(path)
      .because(cause);
}

bool is_limit(int error) { return error == EMFILE || error == ENFILE || error == ENOMEM || error == EAGAIN; }

}  // namespace

bool is_regular_file(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

bool is_device(const std::string& path) {
  if (path == kStandardOutput) return true;
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

std::string folder_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

void for_each_name(const std::string& folder, const std::function<void(const char*)>& visit) {
  const std::unique_ptr<DIR, void (*)(DIR*)> entries(::opendir(folder.c_str()), [](DIR* open) { ::closedir(open); });
  if (entries == nullptr) return;
  while (const dirent* const entry = ::readdir(entries.get())) {
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..") visit(entry->d_name);
  }
}

void sync_folder(const std::string& folder) {
  if (const int error = system::sync_folder(folder); error != 0) throw_output_error(error, folder);
}

Mapping::Mapping(Mapping&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

Mapping::~Mapping() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void Mapping::expect_random_access() const noexcept {
  if (!bytes_.empty()) ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_RANDOM);
}

void Mapping::release_pages() const noexcept {
  if (!bytes_.empty()) ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
}

File::File(int descriptor, const std::string& path, Use use) try : descriptor_(descriptor), path_(path), use_(use) {
} catch (...) {
  ::close(descriptor);
}

File::File(File&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)), use_(other.use_) {}

File& File::operator=(File&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  std::swap(use_, other.use_);
  return *this;
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

File File::open_for_reading(const std::string& path) {
  // Checked first: opening a FIFO would wait for its writer.
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw_input_error(errno, path);
  if (!S_ISREG(status.st_mode)) throw_unreadable("not a regular file", path, ErrorCause::kNone);
  const int descriptor = system::open(path, O_RDONLY);
  if (descriptor < 0) throw_input_error(errno, path);
  return {descriptor, path, Use::kInput};
}

File File::open_for_update(const std::string& path) {
  const int descriptor = system::open(path, O_RDWR | O_NOFOLLOW);
  if (descriptor < 0) throw_input_error(errno, path);
  return {descriptor, path, Use::kTemporary};
}

File File::create(const std::string& path) {
  // Only a file is removed; a device or a link fails below.
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) ::unlink(path.c_str());
  const int descriptor = system::open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  if (descriptor < 0) {
    const int error = errno;
    throw Error(ErrorKind::kResource, std::string("cannot be created: ") + std::strerror(error),
                hint_for(error, "choose a folder that exists and can be written"))
        .at(path)
        .because(cause_of(error));
  }
  return {descriptor, path, Use::kTemporary};
}

std::uint64_t File::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail("ask the size of", errno, 0, 0);
  return static_cast<std::uint64_t>(status.st_size);
}

void File::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
  const auto [done, error] = system::read_at(descriptor_, offset, bytes);
  if (done != bytes.size()) fail("read", error, offset + done, bytes.size() - done);
}

void File::write_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
  const auto [done, error] = system::write_at(descriptor_, offset, bytes);
  if (error != 0) fail("write", error, offset + done, bytes.size() - done);
}

void File::write_next(std::uint64_t offset, std::span<const std::byte> bytes) const {
  const auto [done, error] = system::write_next(descriptor_, bytes);
  if (error != 0) fail("write", error, offset + done, bytes.size() - done);
}

Mapping File::map(std::uint64_t offset, std::size_t bytes) const {
  void* const begin = system::map(descriptor_, offset, bytes);
  if (begin == nullptr) {
    const int error = errno;
    throw Error(ErrorKind::kResource, std::string("cannot be mapped: ") + std::strerror(error),
                hint_for(error, "check that the file is still there"))
        .at(path_, std::to_string(offset))
        .because(cause_of(error));
  }
  Mapping mapping;
  mapping.bytes_ = {static_cast<const std::byte*>(begin), bytes};
  return mapping;
}

void File::sync() const {
  if (const int error = system::sync(descriptor_); error != 0) fail("flush", error, 0, 0);
}

void File::start_sync(std::uint64_t offset, std::uint64_t bytes) const noexcept {
  if (use_ == Use::kOutput) system::start_sync(descriptor_, offset, bytes);
}

void File::fail(const char* doing, int error, std::uint64_t offset, std::size_t bytes) const {
  if (use_ == Use::kOutput) throw_output_error(error == 0 ? EIO : error, path_, std::to_string(offset));
  if (use_ == Use::kInput && error == 0)
    throw Error(ErrorKind::kBadInput, "the file ends here", "the file was cut; make it again")
        .at(path_, std::to_string(offset));
  if (use_ == Use::kInput)
    throw Error(ErrorKind::kBadInput, std::string("cannot be read: ") + std::strerror(error),
                "check the disk, or the connection to it")
        .at(path_, std::to_string(offset))
        .because(ErrorCause::kUnreadable);
  std::string what = std::string("cannot ") + doing + " " + format_bytes(bytes) + ": ";
  what += error == 0 ? "the file ends before" : std::strerror(error);
  const std::string room = bytes == 0 ? "make room" : "free at least " + format_bytes(bytes) + ", better more,";
  const std::string hint = is_full(error) ? room + " on this volume, or " + kOtherTempFolderHint
                                          : hint_for(error, std::string("check the disk, or ") + kOtherTempFolderHint);
  throw Error(ErrorKind::kResource, what, hint).at(path_, std::to_string(offset));
}

std::string hint_for(int error, const std::string& otherwise) {
  if (error == EMFILE || error == ENFILE) return "allow more open files (ulimit -n), or close other programs";
  if (is_limit(error)) return "allow more memory (ulimit -v), or close other programs";
  if (error == EPIPE) return "the program that reads it has ended";
  if (error == EFBIG) return "allow larger files (ulimit -f), or write to another file system";
  return is_full(error) ? "make room on the disk, or write to another folder" : otherwise;
}

void throw_input_error(int error, const std::string& path) {
  if (!is_limit(error))
    throw_unreadable(std::strerror(error), path, error == ENOENT ? ErrorCause::kMissing : ErrorCause::kNone);
  throw Error(ErrorKind::kResource, std::string("cannot be read: ") + std::strerror(error), hint_for(error, {}))
      .at(path)
      .because(cause_of(error));
}

void throw_output_error(int error, const std::string& path, const std::string& position) {
  const bool standard = path == kStandardOutputShown;
  throw Error(ErrorKind::kResource,
              std::string("cannot be written") + (error == 0 ? "" : std::string(": ") + std::strerror(error)),
              hint_for(error, standard ? "check what standard output leads to, or name a file with -o"
                                       : "choose a folder that exists and is writable"))
      .at(path, standard ? "" : position)
      .because(cause_of(error));
}

}  // namespace reeb::io
