#include "ooc/reeb_writer/record_source.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "libreeb/graph/packed_buckets.h"

namespace reeb::ooc {

SortedRecords::SortedRecords(const std::vector<ArcVersion>& records, const ArcBucketsView& buckets)
    : records_(records), buckets_(buckets), order_(records.size()) {
  if (!buckets.empty() && buckets.offsets.size() != records.size() + 1)
    throw std::logic_error("SortedRecords: buckets do not match records");
  std::iota(order_.begin(), order_.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const ArcVersion& arc = records[i];
    return std::tuple(kNeverDies - arc.died, arc.lo, arc.hi, arc.born, i);
  };
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
}

bool SortedRecords::next(PackedRecord& record) {
  if (next_ == order_.size()) return false;
  const std::uint32_t i = order_[next_++];
  const std::span<const Bucket> buckets = buckets_.of(i);
  packed_.clear();
  if (reads_buckets_) pack_buckets(buckets, packed_);
  record = {records_[i], static_cast<std::uint32_t>(buckets.size()), packed_};
  return true;
}

}  // namespace reeb::ooc
