#include "ooc/reeb_writer/record_log.h"

#include <cstring>
#include <utility>

#include "libreeb/base/byte_coding.h"
#include "libreeb/graph/packed_buckets.h"

namespace reeb::ooc {
namespace {

struct Entry {
  std::uint32_t lo, hi, born, died;
  std::uint32_t bucket_count, bucket_bytes;
};

// Removes the last `count` bytes and returns them.
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
  open_.reserve(block_bytes);
  fetched_.reserve(block_bytes);
}

void RecordLog::add(const ArcVersion& record, std::span<const std::byte> buckets) {
  if (!open_.entries.empty() && open_.bytes() + buckets.size() + sizeof(Entry) > block_bytes_) seal_block();
  const Entry entry{record.lo.value(),
                    record.hi.value(),
                    record.born,
                    record.died,
                    static_cast<std::uint32_t>(packed_count(buckets)),
                    static_cast<std::uint32_t>(buckets.size())};
  ByteWriter(open_.entries).bytes(std::as_bytes(std::span(&entry, 1)));
  ByteWriter(open_.buckets).bytes(buckets);
  ++count_;
}

void RecordLog::seal_block() {
  writer_.wait();
  if (!file_) file_.emplace(temp_->create_unnamed("arc records"));
  offsets_.push_back(file_->size());
  std::swap(open_, fetched_);
  const auto write = [this] {
    const std::size_t records = fetched_.entries.size() / sizeof(Entry);
    file_->append(fetched_.entries, records);
    file_->append(fetched_.buckets, records);
  };
  if (background_)
    writer_.start(write);
  else
    write();
  open_.clear();
}

void RecordLog::rewind(Buckets buckets) {
  writer_.wait();
  reads_buckets_ = buckets == Buckets::kRead;
  blocks_left_ = offsets_.size();
  unread_entries_ = open_.entries;
  unread_buckets_ = open_.buckets;
}

bool RecordLog::next(PackedRecord& record) {
  if (unread_entries_.empty()) {
    if (blocks_left_ == 0) return false;
    fetch_block();
  }
  Entry entry;
  std::memcpy(&entry, take_last(unread_entries_, sizeof(entry)).data(), sizeof(entry));
  record = {{NodeId(entry.lo), NodeId(entry.hi), entry.born, entry.died}, entry.bucket_count};
  if (reads_buckets_) record.buckets = take_last(unread_buckets_, entry.bucket_bytes);
  return true;
}

void RecordLog::fetch_block() {
  RunPlace parts{offsets_[--blocks_left_], 2};
  file_->read(parts, fetched_.entries);
  if (reads_buckets_) file_->read(parts, fetched_.buckets);
  unread_entries_ = fetched_.entries;
  unread_buckets_ = fetched_.buckets;
}

}  // namespace reeb::ooc
