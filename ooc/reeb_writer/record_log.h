// The arc records of a hierarchy on disk: written in the order in which they end, read from the last to the first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/record_sink.h"
#include "ooc/reeb_writer/record_source.h"
#include "ooc/sorting/sorted_run_file.h"
#include "ooc/threads/worker.h"

namespace reeb::ooc {

// A record is its packed buckets, followed by its fields and the byte count of the buckets, so that a block can be read
// from its end: 20 bytes per record, and its buckets. Each block has a checksum. No file is made while one block is
// enough.
//
// MEMORY: two blocks, and 8 bytes per block of the file.
// THROWS: Error{kResource} if the disk is full, or returns other bytes than were written, or the budget lacks two
//         blocks. An error in the background is thrown by a later call.
class RecordLog : public RecordSink, public RecordSource {
 public:
  static constexpr std::size_t kBlockBytes = 64 << 10;
  // Larger blocks for large graphs: whenever a block is full, two threads wait for each other.
  static constexpr std::size_t block_bytes(std::uint64_t arcs) {
    constexpr std::uint64_t kMostBytes = 8 * kBlockBytes;
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(arcs, kBlockBytes, kMostBytes));
  }

  // The memory of one log.
  static constexpr std::uint64_t memory_bytes(std::size_t block_bytes = kBlockBytes) { return 2 * block_bytes; }

  // `temp` must outlive this. A block holds at least one record, however large. With `background`, a thread writes each
  // block while the next is filled.
  RecordLog(const io::TempDir& temp, MemoryBudget& budget, std::size_t block_bytes = kBlockBytes,
            bool background = false);

  void add(const ArcVersion& record, std::span<const std::byte> buckets) override;

  // REQUIRES, for everything below: nothing more is added.
  void rewind() override;
  bool next(ArcVersion& record, std::span<const std::byte>& buckets) override;

  std::uint64_t record_count() const { return count_; }
  // REQUIRES: rewind() was called.
  std::uint64_t spilled_bytes() const { return file_ ? file_->size() : 0; }

 private:
  void seal_block();
  bool fetch_block();

  const io::TempDir* temp_;
  const std::size_t block_bytes_;
  const bool background_;
  Reservation charge_;
  std::optional<SortedRunFile> file_;
  std::vector<std::uint64_t> offsets_;  // of the blocks in the file
  std::vector<std::byte> open_;         // the block after them
  std::size_t in_open_ = 0;
  std::uint64_t count_ = 0;

  std::size_t blocks_left_ = 0;        // in the file, to be read
  std::vector<std::byte> fetched_;     // a block of the file: that which is being written, or was read
  std::span<const std::byte> unread_;  // of the current block
  Worker writer_;                      // of fetched_; the last member, so that it is destroyed first
};

}  // namespace reeb::ooc
