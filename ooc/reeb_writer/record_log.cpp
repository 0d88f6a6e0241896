#include "ooc/reeb_writer/record_log.h"

#include <cstring>
#include <utility>

namespace reeb::ooc {
namespace {

// Follows a record's buckets.
struct Trailer {
  std::uint32_t lo, hi, born, died;
  std::uint32_t bucket_bytes;
};

}  // namespace

RecordLog::RecordLog(const io::TempDir& temp, MemoryBudget& budget, std::size_t block_bytes, bool background)
    : temp_(&temp),
      block_bytes_(block_bytes),
      background_(background),
      charge_(budget.reserve("arc records", memory_bytes(block_bytes))) {
  open_.reserve(block_bytes);
}

void RecordLog::add(const ArcVersion& record, std::span<const std::byte> buckets) {
  const std::size_t bytes = buckets.size() + sizeof(Trailer);
  if (in_open_ != 0 && open_.size() + bytes > block_bytes_) seal_block();
  const Trailer trailer{record.lo.value(), record.hi.value(), record.born, record.died,
                        static_cast<std::uint32_t>(buckets.size())};
  const auto trailing = std::as_bytes(std::span(&trailer, 1));
  open_.insert(open_.end(), buckets.begin(), buckets.end());
  open_.insert(open_.end(), trailing.begin(), trailing.end());
  ++in_open_;
  ++count_;
}

void RecordLog::seal_block() {
  writer_.wait();
  if (!file_) file_.emplace(temp_->create_unnamed("arc records"));
  offsets_.push_back(file_->size());
  std::swap(open_, fetched_);
  const auto write = [this, records = in_open_] { file_->append(fetched_, records); };
  if (background_)
    writer_.start(write);
  else
    write();
  open_.clear();
  open_.reserve(block_bytes_);
  in_open_ = 0;
}

void RecordLog::rewind() {
  writer_.wait();
  blocks_left_ = offsets_.size();
  unread_ = open_;
}

bool RecordLog::next(ArcVersion& record, std::span<const std::byte>& buckets) {
  if (unread_.empty() && !fetch_block()) return false;
  Trailer trailer;
  unread_ = unread_.first(unread_.size() - sizeof(trailer));
  std::memcpy(&trailer, unread_.data() + unread_.size(), sizeof(trailer));
  record = {NodeId(trailer.lo), NodeId(trailer.hi), trailer.born, trailer.died};
  buckets = unread_.last(trailer.bucket_bytes);
  unread_ = unread_.first(unread_.size() - trailer.bucket_bytes);
  return true;
}

bool RecordLog::fetch_block() {
  if (blocks_left_ == 0) return false;
  RunPlace place{offsets_[--blocks_left_], 1};
  file_->read(place, fetched_);
  unread_ = fetched_;
  return true;
}

}  // namespace reeb::ooc
