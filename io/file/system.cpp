#include "io/file/system.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "io/file/fault.h"

namespace reeb::io::system {
namespace {

// Repeats the call until no signal interrupts it. A fault replaces the call.
template <class Call>
auto uninterrupted(FileCall kind, const Call& call) noexcept -> decltype(call(std::size_t{})) {
  while (true) {
    const FileFault fault = fault_for(kind);
    if (fault.error != 0) [[unlikely]]
      errno = fault.error;
    else if (const auto result = call(fault.most_bytes); result != -1)
      return result;
    if (errno != EINTR) return -1;
  }
}

// `part(offset, bytes)` transfers some of the bytes from `offset` on.
template <class Byte, class Part>
Transfer in_full(FileCall kind, std::span<Byte> bytes, const Part& part) noexcept {
  Transfer transfer;
  while (transfer.bytes < bytes.size()) {
    const ssize_t got = uninterrupted(kind, [&](std::size_t most) {
      const std::span<Byte> left = bytes.subspan(transfer.bytes);
      return part(transfer.bytes, left.first(std::min(left.size(), most)));
    });
    if (got < 0) transfer.error = errno;
    if (got == 0 && kind == FileCall::kWrite) transfer.error = ENOSPC;
    if (got <= 0) break;
    transfer.bytes += static_cast<std::size_t>(got);
  }
  return transfer;
}

}  // namespace

int open(const std::string& path, int flags, unsigned mode) noexcept {
  return uninterrupted(FileCall::kOpen,
                       [&](std::size_t) { return ::open(path.c_str(), flags | O_CLOEXEC, static_cast<mode_t>(mode)); });
}

int open_unnamed(const std::string& folder) noexcept {
  const int descriptor = open(folder, O_TMPFILE | O_RDWR, 0600);
  // Some file systems do not support files without a name.
  if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return descriptor;
  std::string name = folder + "/reeb-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

int duplicate(int descriptor) noexcept {
  return uninterrupted(FileCall::kOpen, [&](std::size_t) { return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0); });
}

Transfer read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) noexcept {
  return in_full(FileCall::kRead, bytes, [&](std::size_t done, std::span<std::byte> part) {
    return ::pread(descriptor, part.data(), part.size(), static_cast<off_t>(offset + done));
  });
}

Transfer write_at(int descriptor, std::uint64_t offset, std::span<const std::byte> bytes) noexcept {
  return in_full(FileCall::kWrite, bytes, [&](std::size_t done, std::span<const std::byte> part) {
    return ::pwrite(descriptor, part.data(), part.size(), static_cast<off_t>(offset + done));
  });
}

Transfer write_next(int descriptor, std::span<const std::byte> bytes) noexcept {
  return in_full(FileCall::kWrite, bytes, [&](std::size_t /*done*/, std::span<const std::byte> part) {
    return ::write(descriptor, part.data(), part.size());
  });
}

Transfer read_some(int descriptor, std::span<std::byte> bytes) noexcept {
  const ssize_t got = uninterrupted(FileCall::kRead, [&](std::size_t most) {
    return ::read(descriptor, bytes.data(), std::min(bytes.size(), most));
  });
  return got < 0 ? Transfer{0, errno} : Transfer{static_cast<std::size_t>(got), 0};
}

void* map(int descriptor, std::uint64_t offset, std::size_t bytes) noexcept {
  void* mapping = nullptr;
  const int result = uninterrupted(FileCall::kMap, [&](std::size_t) {
    mapping = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, static_cast<off_t>(offset));
    return mapping == MAP_FAILED ? -1 : 0;
  });
  return result == 0 ? mapping : nullptr;
}

void start_sync(int descriptor, std::uint64_t offset, std::uint64_t bytes) noexcept {
  // A failure of the device is reported by sync().
  ::sync_file_range(descriptor, static_cast<off_t>(offset), static_cast<off_t>(bytes), SYNC_FILE_RANGE_WRITE);
}

int sync(int descriptor) noexcept {
  const int result = uninterrupted(FileCall::kSync, [&](std::size_t) { return ::fsync(descriptor); });
  return result == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
}

int sync_folder(const std::string& folder) noexcept {
  const int descriptor = open(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return errno == EACCES ? 0 : errno;
  const int error = sync(descriptor);
  ::close(descriptor);
  return error;
}

int rename(const std::string& from, const std::string& to) noexcept {
  const int result =
      uninterrupted(FileCall::kRename, [&](std::size_t) { return std::rename(from.c_str(), to.c_str()); });
  return result == 0 ? 0 : errno;
}

int rename_to_new(const std::string& from, const std::string& to) noexcept {
  const int result = uninterrupted(FileCall::kRename, [&](std::size_t) {
    return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  });
  if (result == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // Some file systems do not support RENAME_NOREPLACE. link() also refuses a name that exists. Where there are no hard
  // links either, a gap remains between the check and the rename.
  if (::link(from.c_str(), to.c_str()) == 0) {
    ::unlink(from.c_str());
    return 0;
  }
  if (errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS) return errno;
  if (::access(to.c_str(), F_OK) == 0) return EEXIST;
  return rename(from, to);
}

}  // namespace reeb::io::system
