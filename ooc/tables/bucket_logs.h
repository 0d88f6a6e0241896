// Records told apart into buckets, each read back in the order of writing: the partition step of
// joins that would otherwise need random access.
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

// append() all, then next() takes each bucket's records in turn; buckets may be read interleaved.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: 16 KiB a bucket, reserved, and 8 bytes for each 16 KiB written.   THREADS: one at a time.
template <class Record>
class BucketLogs {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  static constexpr std::size_t kBlockBytes = 16 << 10;

  BucketLogs(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::size_t buckets)
      : charge_(budget.reserve(owner, buckets * kBlockBytes)), file_(temp.create_unnamed(owner)), buckets_(buckets) {
    for (Bucket& bucket : buckets_) bucket.records.reserve(kBlockRecords);
  }

  void append(std::size_t index, const Record& record) {
    Bucket& bucket = buckets_[index];
    if (bucket.records.size() == kBlockRecords) {
      file_.write_at(size_, std::as_bytes(std::span<const Record>(bucket.records)));
      bucket.blocks.push_back(size_);
      size_ += kBlockRecords * sizeof(Record);
      bucket.records.clear();
    }
    bucket.records.push_back(record);
    ++bucket.count;
  }

  std::uint64_t count(std::size_t index) const { return buckets_[index].count; }
  std::uint64_t spilled_bytes() const { return size_; }

  // The next record of a bucket. REQUIRES: it has one left, and nothing is appended to it any more.
  const Record& next(std::size_t index) {
    Bucket& bucket = buckets_[index];
    if (bucket.taken % kBlockRecords == 0) fetch(bucket);
    return bucket.records[bucket.taken++ % kBlockRecords];
  }

 private:
  static constexpr std::size_t kBlockRecords = kBlockBytes / sizeof(Record);
  struct Bucket {
    std::vector<Record> records;  // the block at hand
    std::vector<std::uint64_t> blocks;
    std::uint64_t count = 0, taken = 0;
  };

  // The last block was never written: its records wait at the end of the file until they are
  // needed, so that a bucket has one buffer only.
  void fetch(Bucket& bucket) {
    if (bucket.taken == 0 && !bucket.blocks.empty()) {
      file_.write_at(size_, std::as_bytes(std::span<const Record>(bucket.records)));
      bucket.blocks.push_back(size_);
      size_ += bucket.records.size() * sizeof(Record);
    }
    if (bucket.blocks.empty()) return;
    bucket.records.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(kBlockRecords, bucket.count - bucket.taken)));
    file_.read_at(bucket.blocks[static_cast<std::size_t>(bucket.taken / kBlockRecords)],
                  std::as_writable_bytes(std::span(bucket.records)));
  }

  Reservation charge_;
  io::File file_;
  std::uint64_t size_ = 0;
  std::vector<Bucket> buckets_;
};

}  // namespace reeb::ooc
