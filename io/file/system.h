// The system calls on files, each in one function. An interrupted call is repeated, a short transfer is continued, and
// tests can make each call fail (fault.h). No exceptions: only the callers know the name of the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace reeb::io::system {

// These return a descriptor that is closed on exec, or -1 and errno.
int open(const std::string& path, int flags, unsigned mode = 0) noexcept;
// A new file without a name in `folder`, open for reading and writing. It is gone when it is closed, even if the
// process is killed.
int open_unnamed(const std::string& folder) noexcept;
// Another descriptor of the same open file.
int duplicate(int descriptor) noexcept;

struct Transfer {
  std::size_t bytes = 0;
  int error = 0;  // an errno, or 0
};

// Transfers all of `bytes`, unless there is an error. A read that is short without an error reached the end of the
// file.
Transfer read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) noexcept;
Transfer write_at(int descriptor, std::uint64_t offset, std::span<const std::byte> bytes) noexcept;
// The same at the current position of the descriptor, which pipes need.
Transfer write_next(int descriptor, std::span<const std::byte> bytes) noexcept;
// Reads what is available, at most bytes.size(); 0 bytes only at the end.
Transfer read_some(int descriptor, std::span<std::byte> bytes) noexcept;

// Maps for reading. On failure null and errno.
void* map(int descriptor, std::uint64_t offset, std::size_t bytes) noexcept;

// Starts to bring these bytes of the file to the device, without waiting; or does nothing.
void start_sync(int descriptor, std::uint64_t offset, std::uint64_t bytes) noexcept;

// The rest return 0 or an errno.

// Waits until the content is on the device. A pipe, or a file system that cannot wait, is not an error.
int sync(int descriptor) noexcept;
// The same for the names in `folder`. A folder without read permission cannot be waited for, which is not an error.
int sync_folder(const std::string& folder) noexcept;

int rename(const std::string& from, const std::string& to) noexcept;
// EEXIST if the name `to` exists, even if it was created a moment ago.
int rename_to_new(const std::string& from, const std::string& to) noexcept;

}  // namespace reeb::io::system
