// Arc records of a hierarchy, delivered in the order of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/arc_version.h"

namespace reeb::ooc {

// An arc record, the number of its buckets, and the packed buckets if they are read.
struct PackedRecord {
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

  enum class Buckets { kRead, kOnlyCounted };
  // Starts over, with buckets or without.
  virtual void rewind(Buckets buckets) = 0;
  // The next record; its buckets are valid until the next call. False at the end.
  virtual bool next(PackedRecord& record) = 0;
};

// Records in memory, in any order. Equal records keep their order.
// MEMORY: 4 bytes per record.
class SortedRecords : public RecordSource {
 public:
  // `records` and the data that `buckets` refers to must outlive this. `buckets` are those of the records, or empty.
  SortedRecords(const std::vector<ArcVersion>& records, const ArcBucketsView& buckets);

  void rewind(Buckets buckets) override {
    next_ = 0;
    reads_buckets_ = buckets == Buckets::kRead;
  }
  bool next(PackedRecord& record) override;

 private:
  const std::vector<ArcVersion>& records_;
  const ArcBucketsView buckets_;
  std::vector<std::uint32_t> order_;
  std::size_t next_ = 0;
  bool reads_buckets_ = false;
  std::vector<std::byte> packed_;
};

}  // namespace reeb::ooc
