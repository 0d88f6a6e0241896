#include "ooc/reeb_writer/record_log.h"

#include <cstring>
#include <utility>

#include "libreeb/graph/packed_buckets.h"

namespace reeb::ooc {
namespace {

struct Entry {
  std::uint32_t lo, hi, born, died;
  std::uint32_t bucket_count, bucket_bytes;
};

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

// The last bytes, which are taken away.
std::span<const std::byte> take_last(std::span<const std::byte>& bytes, std::size_t count) {
  const auto taken = bytes.last(count);
  bytes = bytes.first(bytes.size() - count);
  return taken;
}

}  // namespace

RecordLog::RecordLog(const io::TempDir& temp, MemoryBudget& budget, std::size_t block_bytes, bool background)
    : temp_(&temp),
      block_bytes_(block_bytes),
      background_(background),
      charge_(budget.reserve("arc records", memory_bytes(block_bytes))) {
  for (Block* block : {&open_, &fetched_})
    for (std::vector<std::byte>* part : {&block->entries, &block->buckets}) part->reserve(block_bytes);
}

void RecordLog::add(const ArcVersion& record, std::span<const std::byte> buckets) {
  if (!open_.entries.empty() && open_.bytes() + buckets.size() + sizeof(Entry) > block_bytes_) seal_block();
  const Entry entry{record.lo.value(),
                    record.hi.value(),
                    record.born,
                    record.died,
                    static_cast<std::uint32_t>(packed_count(buckets)),
                    static_cast<std::uint32_t>(buckets.size())};
  append(open_.entries, std::as_bytes(std::span(&entry, 1)));
  append(open_.buckets, buckets);
  ++count_;
}

void RecordLog::seal_block() {
  writer_.wait();
  if (!file_) file_.emplace(temp_->create_unnamed("arc records"));
  std::swap(open_, fetched_);
  BlockPlace& place = places_.emplace_back();
  const auto write = [this, &place] {
    place.entries = file_->size();
    file_->append(fetched_.entries, fetched_.entries.size() / sizeof(Entry));
    place.buckets = file_->size();
    file_->append(fetched_.buckets, fetched_.entries.size() / sizeof(Entry));
  };
  if (background_)
    writer_.start(write);
  else
    write();
  open_.entries.clear();
  open_.buckets.clear();
}

void RecordLog::rewind(Read what) {
  writer_.wait();
  read_ = what;
  blocks_left_ = places_.size();
  unread_entries_ = open_.entries;
  unread_buckets_ = open_.buckets;
}

bool RecordLog::next(SourceRecord& record) {
  if (unread_entries_.empty()) {
    if (blocks_left_ == 0) return false;
    fetch_block();
  }
  Entry entry;
  std::memcpy(&entry, take_last(unread_entries_, sizeof(entry)).data(), sizeof(entry));
  record.arc = {NodeId(entry.lo), NodeId(entry.hi), entry.born, entry.died};
  record.bucket_count = entry.bucket_count;
  record.buckets = read_ == Read::kAll ? take_last(unread_buckets_, entry.bucket_bytes) : std::span<const std::byte>();
  return true;
}

void RecordLog::fetch_block() {
  const BlockPlace& place = places_[--blocks_left_];
  const auto read = [this](std::uint64_t offset, std::vector<std::byte>& bytes) {
    RunPlace one{offset, 1};
    file_->read(one, bytes);
    return std::span<const std::byte>(bytes);
  };
  unread_entries_ = read(place.entries, fetched_.entries);
  if (read_ == Read::kAll) unread_buckets_ = read(place.buckets, fetched_.buckets);
}

}  // namespace reeb::ooc
