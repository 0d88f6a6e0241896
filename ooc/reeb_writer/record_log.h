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

// A block has two parts, each with a checksum: entries of 24 bytes, one per record, and the packed buckets of all its
// records. So entries can be read without buckets. No file is made while one block is enough.
//
// MEMORY: memory_bytes(): two blocks, each with two parts that can be as large as a block. A record that is larger is
//         not counted. 8 bytes per block of the file.
// THROWS: Error{kResource} if the disk is full, or returns other bytes than were written, or the budget lacks
//         memory_bytes(). An error in the background is thrown by a later call.
class RecordLog : public RecordSink, public RecordSource {
 public:
  static constexpr std::size_t kBlockBytes = 64 << 10;
  // Larger blocks for large graphs: whenever a block is full, two threads wait for each other.
  static constexpr std::size_t block_bytes(std::uint64_t arcs) {
    constexpr std::uint64_t kMostBytes = 8 * kBlockBytes;
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(arcs, kBlockBytes, kMostBytes));
  }

  // The memory of one log.
  static constexpr std::uint64_t memory_bytes(std::size_t block_bytes = kBlockBytes) { return 4 * block_bytes; }

  // `temp` must outlive this. A block holds at least one record, however large. With `background`, a thread writes each
  // block while the next is filled.
  RecordLog(const io::TempDir& temp, MemoryBudget& budget, std::size_t block_bytes = kBlockBytes,
            bool background = false);

  void add(const ArcVersion& record, std::span<const std::byte> buckets) override;

  // REQUIRES, for everything below: nothing more is added.
  void rewind(Buckets buckets) override;
  bool next(PackedRecord& record) override;

  std::uint64_t record_count() const { return count_; }
  // REQUIRES: rewind() was called.
  std::uint64_t spilled_bytes() const { return file_ ? file_->size() : 0; }

 private:
  struct Block {
    std::vector<std::byte> entries, buckets;
    std::size_t bytes() const { return entries.size() + buckets.size(); }
    void reserve(std::size_t bytes) {
      entries.reserve(bytes);
      buckets.reserve(bytes);
    }
    void clear() {
      entries.clear();
      buckets.clear();
    }
  };

  void seal_block();
  void fetch_block();

  const io::TempDir* temp_;
  const std::size_t block_bytes_;
  const bool background_;
  Reservation charge_;
  std::optional<SortedRunFile> file_;
  std::vector<std::uint64_t> offsets_;  // of the blocks in the file
  Block open_;                          // the block after them
  std::uint64_t count_ = 0;

  bool reads_buckets_ = false;
  std::size_t blocks_left_ = 0;  // in the file, to be read
  Block fetched_;                // a block of the file: that which is being written, or was read
  std::span<const std::byte> unread_entries_, unread_buckets_;  // of the current block
  Worker writer_;  // of fetched_; the last member, so that it is destroyed first
};

}  // namespace reeb::ooc
