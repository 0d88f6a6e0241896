// Arc records of a hierarchy, delivered in the order of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::ooc {

// An arc record with its buckets, packed.
struct SourceRecord {
  ArcVersion arc;
  std::uint32_t bucket_count = 0;
  std::span<const std::byte> buckets{};
};

// Delivers the records by `died` descending, then by (lo, hi, born).
class RecordSource {
 public:
  RecordSource() = default;
  RecordSource(const RecordSource&) = delete;
  RecordSource& operator=(const RecordSource&) = delete;
  virtual ~RecordSource() = default;

  // What is read of the records: all of it, or only the number of buckets instead of the buckets.
  enum class Read { kAll, kCounts };
  // Starts over.
  virtual void rewind(Read what) = 0;
  // The next record; its buckets are valid until the next call. False at the end.
  virtual bool next(SourceRecord& record) = 0;
};

// Records in memory, in any order. Equal records keep their order.
// MEMORY: 4 bytes per record.
class SortedRecords : public RecordSource {
 public:
  // `records` and the data that `buckets` refers to must outlive this. `buckets` are those of the records, or empty.
  SortedRecords(const std::vector<ArcVersion>& records, const ArcBucketsView& buckets);

  void rewind(Read what) override {
    next_ = 0;
    read_ = what;
  }
  bool next(SourceRecord& record) override;

 private:
  const std::vector<ArcVersion>& records_;
  const ArcBucketsView buckets_;
  std::vector<std::uint32_t> order_;
  std::size_t next_ = 0;
  Read read_ = Read::kAll;
  std::vector<std::byte> packed_;
};

}  // namespace reeb::ooc
