// Records divided into parts, each read back in the order of writing: the partition step of joins that would otherwise
// access memory at random.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

// Call append() for all records; then next() delivers the records of each part in order. Parts can be read interleaved,
// and more than once.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: 16 KiB per part, reserved, and 8 bytes for each 16 KiB written.   THREADS: one at a time.
template <class Record>
class PartitionLogs {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  static constexpr std::size_t kBlockBytes = 16 << 10;

  PartitionLogs(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::size_t parts)
      : charge_(budget.reserve(owner, parts * kBlockBytes)), file_(temp.create_unnamed(owner)), parts_(parts) {
    for (Part& part : parts_) part.records.reserve(kBlockRecords);
  }

  void append(std::size_t index, const Record& record) {
    Part& part = parts_[index];
    if (part.records.size() == kBlockRecords) {
      file_.write_at(size_, std::as_bytes(std::span<const Record>(part.records)));
      part.blocks.push_back(size_);
      size_ += kBlockRecords * sizeof(Record);
      part.records.clear();
    }
    part.records.push_back(record);
    ++part.count;
  }

  std::uint64_t count(std::size_t index) const { return parts_[index].count; }
  std::uint64_t spilled_bytes() const { return size_; }

  // Starts over with the first record of a part. REQUIRES: nothing more is appended.
  void rewind(std::size_t index) { parts_[index].taken = 0; }
  // The next record of a part. REQUIRES: the part has one left, and nothing more is appended.
  const Record& next(std::size_t index) {
    Part& part = parts_[index];
    if (part.taken % kBlockRecords == 0) fetch(part);
    return part.records[part.taken++ % kBlockRecords];
  }
  // The same for all that is left of a block, until the next call for this part. Empty at the end.
  std::span<const Record> next_block(std::size_t index) {
    Part& part = parts_[index];
    if (part.taken == part.count) return {};
    if (part.taken % kBlockRecords == 0) fetch(part);
    const auto rest = std::span<const Record>(part.records).subspan(part.taken % kBlockRecords);
    part.taken += rest.size();
    return rest;
  }

 private:
  static constexpr std::size_t kBlockRecords = kBlockBytes / sizeof(Record);
  struct Part {
    std::vector<Record> records;  // the current block
    std::vector<std::uint64_t> blocks;
    std::uint64_t count = 0, taken = 0;
  };

  // The last block was never written. Its records move to the end of the file when reading starts, so that a part needs
  // only one buffer.
  void fetch(Part& part) {
    if (part.blocks.size() * kBlockRecords < part.count && !part.blocks.empty()) {
      file_.write_at(size_, std::as_bytes(std::span<const Record>(part.records)));
      part.blocks.push_back(size_);
      size_ += part.records.size() * sizeof(Record);
    }
    if (part.blocks.empty()) return;
    part.records.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlockRecords, part.count - part.taken)));
    file_.read_at(part.blocks[static_cast<std::size_t>(part.taken / kBlockRecords)],
                  std::as_writable_bytes(std::span(part.records)));
  }

  Reservation charge_;
  io::File file_;
  std::uint64_t size_ = 0;
  std::vector<Part> parts_;
};

}  // namespace reeb::ooc
