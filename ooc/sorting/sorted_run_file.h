// Checksummed blocks of sorted runs, one run after the other in a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"

namespace reeb::ooc {

// Where a run lies, and how far it was read.
struct RunPlace {
  std::uint64_t offset = 0;
  std::uint64_t blocks = 0;
};

// What is in a file of runs, for another process to go on with it.
struct RunManifest {
  std::uint64_t bytes = 0;
  std::uint64_t records = 0;
  std::uint64_t digest = 0;  // of the headers of all blocks, one after the other
  friend bool operator==(const RunManifest&, const RunManifest&) = default;
};

// THROWS: Error{kResource} if the disk is full, or gives back other bytes than were written.
// THREADS: one writer or many readers.
class SortedRunFile {
 public:
  explicit SortedRunFile(io::File file) : file_(std::move(file)) {}

  // Goes on with a file of an earlier process; what follows after the manifest's bytes is lost.
  // THROWS: DamagedState if the bytes are not those that the manifest tells of. O(bytes).
  SortedRunFile(io::File file, const RunManifest& manifest);

  // Where the next block goes.
  std::uint64_t size() const { return manifest_.bytes; }
  const RunManifest& manifest() const { return manifest_; }
  // Returns once all that was appended has reached the device.
  void sync() const { file_.sync(); }
  void append(std::span<const std::byte> packed, std::size_t records);
  // Reads the next block of `run`, which has one, and moves on. Returns the number of records.
  std::size_t read(RunPlace& run, std::vector<std::byte>& packed) const;

  [[noreturn]] void refuse(std::uint64_t offset) const;

 private:
  io::File file_;
  RunManifest manifest_;
};

}  // namespace reeb::ooc
