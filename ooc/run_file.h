// Checksummed blocks of sorted runs, one run after the other in an unnamed file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ooc/file.h"
#include "ooc/temp_dir.h"

namespace reeb::ooc {

// Where a run lies, and how far it was read.
struct RunPlace {
  std::uint64_t offset = 0;
  std::uint64_t blocks = 0;
};

// THROWS: Error{kResource} if the disk is full, or gives back other bytes than were written.
// THREADS: one writer or many readers.
class RunFile {
 public:
  explicit RunFile(File file) : file_(std::move(file)) {}

  // Where the next block goes.
  std::uint64_t size() const { return size_; }
  void append(std::span<const std::byte> packed, std::size_t records);
  // Reads the next block of `run`, which has one, and moves on. Returns the number of records.
  std::size_t read(RunPlace& run, std::vector<std::byte>& packed) const;

  [[noreturn]] void refuse(std::uint64_t offset) const;

 private:
  File file_;
  std::uint64_t size_ = 0;
};

}  // namespace reeb::ooc
