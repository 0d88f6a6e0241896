// Records divided into parts, each read back in the order of writing: the partition step of joins that would otherwise
// access memory at random.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

// Call append() for all records; then next() delivers the records of each part in order. Parts can be read interleaved,
// and more than once.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: a block per part, reserved, and 8 bytes for each block written.   THREADS: one at a time.
template <class Record>
class PartitionLogs {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  // Blocks are small unless others are asked for. Large ones save calls; twice their size saves no more.
  static constexpr std::size_t kBlockBytes = 16 << 10, kLargeBlockBytes = 2 * kBlockBytes;

  PartitionLogs(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::size_t parts,
                std::size_t block_bytes = kBlockBytes)
      : block_records_(block_bytes / sizeof(Record)),
        charge_(budget.reserve(owner, parts * block_bytes)),
        file_(temp.create_unnamed(owner)),
        parts_(parts) {
    for (Part& part : parts_) {
      part.block = std::make_unique_for_overwrite<Record[]>(block_records_);
      part.at = part.block.get();
      part.full = part.at + block_records_;
    }
  }

  void append(std::size_t index, const Record& record) {
    Part& part = parts_[index];
    if (part.at == part.full) [[unlikely]] {
      write_block(part);
      part.written += block_records_;
      part.at = part.block.get();
    }
    *part.at++ = record;
  }

  std::uint64_t count(std::size_t index) const { return count(parts_[index]); }
  std::uint64_t spilled_bytes() const { return size_; }

  // Starts over with the first record of a part. REQUIRES: nothing more is appended.
  void rewind(std::size_t index) {
    Part& part = parts_[index];
    part.fetched = 0;
    part.next = part.end = nullptr;
  }
  // The next record of a part, until the next call for this part. REQUIRES: the part has one left, and nothing more is
  // appended.
  const Record& next(std::size_t index) {
    Part& part = parts_[index];
    if (part.next == part.end) [[unlikely]]
      fetch(part);
    return *part.next++;
  }
  // The same for all that is left of a block. Empty at the end.
  std::span<const Record> next_block(std::size_t index) {
    Part& part = parts_[index];
    if (part.next == part.end && part.fetched != count(part)) fetch(part);
    return {std::exchange(part.next, part.end), part.end};
  }

  // Calls visit(records) for all records of a part, some at a time, to change them where they are. Reading starts over.
  // REQUIRES: nothing more is appended.
  template <class Visit>
  void change(std::size_t index, const Visit& visit) {
    Part& part = parts_[index];
    rewind(index);
    while (part.fetched != count(part)) {
      const std::uint64_t first = part.fetched;
      fetch(part);
      const std::span<Record> records(part.block.get(), static_cast<std::size_t>(part.fetched - first));
      visit(records);
      if (!part.blocks.empty())
        file_.write_at(part.blocks[static_cast<std::size_t>(first / block_records_)], std::as_bytes(records));
    }
    rewind(index);
  }

 private:
  struct Part {
    std::unique_ptr<Record[]> block;  // the current one
    Record* at = nullptr;             // in it, where the next record is appended; stays when reading starts
    const Record* full = nullptr;     // its end, with which every append compares
    const Record* next = nullptr;     // in it, to be read; up to `end`
    const Record* end = nullptr;
    std::uint64_t written = 0, fetched = 0;  // records in full blocks of the file, and up to `end`
    std::vector<std::uint64_t> blocks;       // where they are
  };

  static std::uint64_t count(const Part& part) {
    return part.written + static_cast<std::uint64_t>(part.at - part.block.get());
  }

  void write_block(Part& part) {
    const std::span<const Record> records(part.block.get(), part.at);
    file_.write_at(size_, std::as_bytes(records));
    part.blocks.push_back(size_);
    size_ += records.size_bytes();
  }

  // The last block was never written. Its records move to the end of the file when reading starts, so that a part needs
  // only one buffer.
  void fetch(Part& part) {
    const std::uint64_t all = count(part);
    if (part.blocks.size() * block_records_ < all && !part.blocks.empty()) write_block(part);
    const auto records = static_cast<std::size_t>(std::min<std::uint64_t>(block_records_, all - part.fetched));
    if (!part.blocks.empty())
      file_.read_at(part.blocks[static_cast<std::size_t>(part.fetched / block_records_)],
                    std::as_writable_bytes(std::span(part.block.get(), records)));
    part.next = part.block.get();
    part.end = part.next + records;
    part.fetched += records;
  }

  std::size_t block_records_;
  Reservation charge_;
  io::File file_;
  std::uint64_t size_ = 0;
  std::vector<Part> parts_;
};

}  // namespace reeb::ooc
