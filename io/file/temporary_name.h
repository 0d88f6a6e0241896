// The names of files that must not outlive what they are for, nor the process.
#pragma once

#include <cstddef>
#include <string>

namespace reeb::io {

// Owns the name of a file that this process has created. The destructor removes the name. A process that a signal ends
// has no destructors, so a signal handler can remove all names that exist at that moment.
// THREADS: any.
class TemporaryName {
 public:
  TemporaryName() = default;
  // REQUIRES: this process has created the file.
  explicit TemporaryName(std::string path);
  TemporaryName(TemporaryName&& other) noexcept;
  TemporaryName& operator=(TemporaryName&& other) noexcept;
  ~TemporaryName();

  bool empty() const { return path_.empty(); }
  const std::string& path() const { return path_; }
  // The file stays, since it has another name now.
  void release() noexcept;

 private:
  static constexpr std::size_t kNoSlot = ~std::size_t{0};

  std::string path_;
  std::size_t slot_ = kNoSlot;  // in the table that a handler reads
};

// Removes the names of all that exist. Does only what a signal handler may do.
void remove_temporary_names() noexcept;

}  // namespace reeb::io
