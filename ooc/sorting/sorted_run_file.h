// Checksummed blocks of sorted runs, one run after the other in a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/file/file.h"

namespace reeb::ooc {

// Where the rest of a run starts, and the number of its blocks.
struct RunPlace {
  std::uint64_t offset = 0;
  std::uint64_t blocks = 0;
};

// Describes the content of a file of runs, so that another process can continue it.
struct RunManifest {
  std::uint64_t bytes = 0;
  std::uint64_t records = 0;
  std::uint64_t digest = 0;  // of the headers of all blocks, one after the other
  friend bool operator==(const RunManifest&, const RunManifest&) = default;
};

// THROWS: Error{kResource} if the disk is full, or returns other bytes than were written.
// THREADS: one writer or many readers.
class SortedRunFile {
 public:
  explicit SortedRunFile(io::File file) : file_(std::move(file)) {}

  // Continues a file of an earlier process. Bytes after those of the manifest are ignored.
  // THROWS: DamagedState if the bytes are not those that the manifest describes.   TIME: O(bytes).
  SortedRunFile(io::File file, const RunManifest& manifest);

  // Whether these runs, one after the other, are the whole file.
  bool consists_of(std::span<const RunPlace> runs) const;
  // The position of the next block.
  std::uint64_t size() const { return manifest_.bytes; }
  const RunManifest& manifest() const { return manifest_; }
  // Returns once all that was appended has reached the device.
  void sync() const { file_.sync(); }
  void append(std::span<const std::byte> packed, std::size_t records);
  // Reads the next block of `run` and advances it. Returns the number of records. REQUIRES: the run has a next block.
  std::size_t read(RunPlace& run, std::vector<std::byte>& packed) const;

  [[noreturn]] void refuse(std::uint64_t offset) const;

 private:
  io::File file_;
  RunManifest manifest_;
};

}  // namespace reeb::ooc
