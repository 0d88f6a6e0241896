// The system's calls on files, each in one place: what a signal interrupts is called again, what is short goes on, and
// tests can let each fail (fault.h). No exceptions: the callers know how the file is named.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace reeb::io::system {

// All that open descriptors are closed on exec. They return a descriptor, or -1 and errno.
int open(const std::string& path, int flags, unsigned mode = 0) noexcept;
// A new file without a name in `folder`, open for reading and writing: gone when it is closed, however that comes
// about.
int open_unnamed(const std::string& folder) noexcept;

struct Transfer {
  std::size_t bytes = 0;
  int error = 0;  // an errno, or 0
};

// All of `bytes`, unless there is an error. A read that is short without one met the end of the file.
Transfer read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) noexcept;
Transfer write_at(int descriptor, std::uint64_t offset, std::span<const std::byte> bytes) noexcept;
// The same where the descriptor stands, as pipes need it.
Transfer write_next(int descriptor, std::span<const std::byte> bytes) noexcept;
// What is there to read, at most bytes.size(); 0 bytes only at the end.
Transfer read_some(int descriptor, std::span<std::byte> bytes) noexcept;

// For reading. Null and errno if there is no mapping.
void* map(int descriptor, std::uint64_t offset, std::size_t bytes) noexcept;

// The rest return 0 or an errno.

// Waits until the content is on the device. A pipe, or a file system that cannot wait, is no error.
int sync(int descriptor) noexcept;
// The same for the names in `folder`. A folder that may not be read cannot be waited for, which is no error.
int sync_folder(const std::string& folder) noexcept;

int rename(const std::string& from, const std::string& to) noexcept;
// EEXIST if there is something with the name `to`, also if it came at this moment.
int rename_to_new(const std::string& from, const std::string& to) noexcept;

}  // namespace reeb::io::system
