// Arc records of a hierarchy, delivered in the order of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::ooc {

// Delivers the records by `died` descending, then by (lo, hi, born). rewind() starts over.
class RecordSource {
 public:
  RecordSource() = default;
  RecordSource(const RecordSource&) = delete;
  RecordSource& operator=(const RecordSource&) = delete;
  virtual ~RecordSource() = default;

  virtual void rewind() = 0;
  // The next record and its packed buckets. The buckets are valid until the next call. False at the end.
  virtual bool next(ArcVersion& record, std::span<const std::byte>& buckets) = 0;
};

// Records in memory, in any order. Equal records keep their order.
// MEMORY: 4 bytes per record.
class SortedRecords : public RecordSource {
 public:
  // `records` and the data that `buckets` refers to must outlive this. `buckets` are those of the records, or empty.
  SortedRecords(const std::vector<ArcVersion>& records, const ArcBucketsView& buckets);

  void rewind() override { next_ = 0; }
  bool next(ArcVersion& record, std::span<const std::byte>& buckets) override;

 private:
  const std::vector<ArcVersion>& records_;
  const ArcBucketsView buckets_;
  std::vector<std::uint32_t> order_;
  std::size_t next_ = 0;
  std::vector<std::byte> packed_;
};

}  // namespace reeb::ooc
