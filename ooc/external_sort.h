// Sorts more records than memory holds: sorted runs on disk, merged while they are read back.
#pragma once

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/base/state_stream.h"
#include "ooc/run_file.h"
#include "ooc/temp_dir.h"

namespace reeb::ooc {

// How a block of sorted records becomes bytes: as it lies in memory. Another codec has the same
// two functions; decode is false if the bytes are not a block of so many records.
template <class Record>
struct PlainCodec {
  static void encode(std::span<const Record> records, std::vector<std::byte>& packed) {
    const auto bytes = std::as_bytes(records);
    packed.assign(bytes.begin(), bytes.end());
  }
  static bool decode(std::span<const std::byte> packed, std::span<Record> records) {
    if (packed.size() != records.size_bytes()) return false;
    std::memcpy(records.data(), packed.data(), packed.size());
    return true;
  }
};

struct SortOptions {
  std::uint64_t allowance_bytes = 16 << 20;  // of the budget
  bool parallel = false;    // sort each run with all threads
  bool background = false;  // sort and write runs in a thread of its own, with half the buffer
  std::string file = {};    // for the runs, if another process may have to go on; else unnamed
};

// Merges sorted runs of a file. Holds one block of each run.
template <class Record, class Codec, class Less>
class RunMerger {
 public:
  RunMerger(const RunFile& file, std::span<const RunPlace> runs, Less less)
      : file_(&file), less_(less) {
    for (const RunPlace& run : runs)
      if (Cursor cursor{run, {}, 0}; refill(cursor)) heap_.push_back(std::move(cursor));
    for (std::size_t i = heap_.size() / 2; i-- > 0;) sift_down(i);
  }

  // Null at the end.
  const Record* front() const { return heap_.empty() ? nullptr : &heap_.front().current(); }
  void pop() {
    Cursor& top = heap_.front();
    if (++top.at == top.records.size() && !refill(top)) {
      if (heap_.size() > 1) top = std::move(heap_.back());
      heap_.pop_back();
    }
    sift_down(0);
  }

 private:
  struct Cursor {
    RunPlace rest;
    std::vector<Record> records;  // the block at hand
    std::size_t at = 0;
    const Record& current() const { return records[at]; }
  };

  bool refill(Cursor& cursor) {
    if (cursor.rest.blocks == 0) return false;
    const std::uint64_t offset = cursor.rest.offset;
    cursor.records.resize(file_->read(cursor.rest, packed_));
    if (!Codec::decode(packed_, cursor.records)) file_->refuse(offset);
    cursor.at = 0;
    return true;
  }

  void sift_down(std::size_t i) {
    for (std::size_t child; (child = 2 * i + 1) < heap_.size(); i = child) {
      if (child + 1 < heap_.size() && less_(heap_[child + 1].current(), heap_[child].current()))
        ++child;
      if (!less_(heap_[child].current(), heap_[i].current())) return;
      std::swap(heap_[i], heap_[child]);
    }
  }

  const RunFile* file_;
  Less less_;
  std::vector<std::byte> packed_;
  std::vector<Cursor> heap_;  // smallest current record first
};

// add() any number of records, finish(), then read() them in order, as often as rewind() says.
// While all fit in the allowance no file is made.
//
// THROWS: Error{kResource} of the budget or the disk; what fails in the background is thrown by
//         the next call.
// MEMORY: the allowance, all of it reserved as it is needed, and a few blocks of 64 KiB.
// THREADS: one at a time.
template <class Record, class Codec = PlainCodec<Record>, class Less = std::less<Record>>
class ExternalSort {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  static constexpr std::size_t kBlockRecords = (64 << 10) / sizeof(Record);

  // `owner` is a string literal for the budget's texts; `temp` and `budget` must outlive this.
  ExternalSort(const char* owner, const TempDir& temp, MemoryBudget& budget,
               const SortOptions& options = {})
      : owner_(owner),
        temp_(&temp),
        options_(options),
        most_records_(std::max<std::size_t>(
            kBlockRecords, static_cast<std::size_t>(options.allowance_bytes /
                                                    (options.background ? 2 : 1) / sizeof(Record)))),
        filling_{{}, budget.reserve(owner, 0)},
        writing_{{}, budget.reserve(owner, 0)},
        merge_charge_(budget.reserve(owner, 0)) {}
  ExternalSort(const ExternalSort&) = delete;
  ExternalSort& operator=(const ExternalSort&) = delete;
  ~ExternalSort() {
    if (written_.valid()) written_.wait();
  }

  void add(std::span<const Record> records) {
    size_ += records.size();
    while (!records.empty()) {
      auto& buffer = filling_.records;
      if (buffer.size() == buffer.capacity() && !grow()) flush();
      const std::size_t count = std::min(records.size(), buffer.capacity() - buffer.size());
      buffer.insert(buffer.end(), records.begin(), records.begin() + static_cast<std::ptrdiff_t>(count));
      records = records.subspan(count);
    }
  }
  void add(const Record& record) { add(std::span(&record, 1)); }

  // All that was added so far, for another process: the runs once they are on the device, and what
  // is still in memory. REQUIRES: a named file, and that finish() was not called.
  void save(StateWriter& out) {
    wait_for_writer();
    if (file_) file_->sync();
    out.put_array(runs_);
    out.put(file_ ? file_->manifest() : RunManifest{});
    out.put_array(filling_.records);
  }
  // REQUIRES: a named file, and that nothing was added yet.
  // THROWS: DamagedState or Error if the file of the runs is missing or not what it was.
  void restore(StateReader& in) {
    in.get_array(runs_);
    const auto manifest = in.get<RunManifest>();
    if (!runs_.empty()) file_.emplace(File::open_for_update(options_.file), manifest);
    size_ = manifest.records;
    std::vector<Record> records;
    in.get_array(records);
    add(records);
  }

  void finish() {
    wait_for_writer();
    if (runs_.empty()) {
      sort(filling_.records);
    } else {
      flush();
      wait_for_writer();
      filling_.free();
      writing_.free();
      reduce_runs();
    }
    rewind();
  }

  // Starts again from the first record. REQUIRES: finish() was called.
  void rewind() {
    at_ = 0;
    if (!runs_.empty()) merger_.emplace(*file_, runs_, Less());
  }

  // Replaces `out` by at most `limit` next records in order; false at the end.
  bool read(std::vector<Record>& out, std::size_t limit) {
    out.clear();
    if (!merger_) {
      const auto first = filling_.records.begin() + static_cast<std::ptrdiff_t>(at_);
      const std::size_t count = std::min(limit, filling_.records.size() - at_);
      out.assign(first, first + static_cast<std::ptrdiff_t>(count));
      at_ += count;
      return count != 0;
    }
    for (const Record* next; out.size() < limit && (next = merger_->front()) != nullptr;) {
      out.push_back(*next);
      merger_->pop();
    }
    return !out.empty();
  }

  std::uint64_t size() const { return size_; }
  // Bytes written so far, merging passes included.
  std::uint64_t spilled_bytes() const { return spilled_ + (file_ ? file_->size() : 0); }

 private:
  using Merger = RunMerger<Record, Codec, Less>;
  struct Buffer {
    std::vector<Record> records;
    Reservation charge;
    void free() {
      std::vector<Record>().swap(records);
      charge.resize(0);
    }
  };
  static constexpr std::uint64_t kCursorBytes = 2 * (64 << 10);  // a block, and what it grew from

  bool grow() {
    auto& buffer = filling_.records;
    const std::size_t before = buffer.capacity();
    const std::size_t after = std::min(most_records_, std::max(kBlockRecords, 2 * before));
    if (after <= before) return false;
    // Both the old and the new memory exist while records move over.
    if (!filling_.charge.try_resize((before + after) * sizeof(Record))) {
      if (before == 0) filling_.charge.resize(kBlockRecords * sizeof(Record));
      return before == 0 ? (buffer.reserve(kBlockRecords), true) : false;
    }
    buffer.reserve(after);
    filling_.charge.resize(buffer.capacity() * sizeof(Record));
    return true;
  }

  void flush() {
    wait_for_writer();
    if (filling_.records.empty()) return;
    if (!file_) file_.emplace(options_.file.empty() ? temp_->create_unnamed(owner_) : File::create(options_.file));
    std::swap(filling_, writing_);
    if (options_.background) {
      written_ = std::async(std::launch::async, [this] { write_run(writing_.records); });
    } else {
      write_run(writing_.records);
      std::swap(filling_, writing_);
    }
    // A budget too small for a second buffer is met by waiting for the first.
    if (filling_.records.capacity() == 0 && !grow_second()) {
      wait_for_writer();
      std::swap(filling_, writing_);
    }
  }

  bool grow_second() {
    if (!filling_.charge.try_resize(kBlockRecords * sizeof(Record))) return false;
    filling_.records.reserve(kBlockRecords);
    return true;
  }

  void wait_for_writer() {
    if (written_.valid()) written_.get();
  }

  void sort(std::vector<Record>& records) const {
    if (options_.parallel)
      tbb::parallel_sort(records.begin(), records.end(), Less());
    else
      std::sort(records.begin(), records.end(), Less());
  }

  void write_run(std::vector<Record>& records) {
    sort(records);
    RunPlace run{file_->size(), 0};
    std::vector<std::byte> packed;
    for (std::size_t first = 0; first < records.size(); first += kBlockRecords, ++run.blocks)
      write_block(std::span<const Record>(records).subspan(
                      first, std::min(kBlockRecords, records.size() - first)),
                  *file_, packed);
    records.clear();
    runs_.push_back(run);
  }

  static void write_block(std::span<const Record> records, RunFile& file,
                          std::vector<std::byte>& packed) {
    packed.clear();
    Codec::encode(records, packed);
    file.append(packed, records.size());
  }

  // Merges in passes until the runs left can be merged at once.
  void reduce_runs() {
    const std::size_t fan_in = reserve_fan_in();
    while (runs_.size() > fan_in) {
      RunFile merged(temp_->create_unnamed(owner_));
      std::vector<RunPlace> longer;
      for (std::size_t first = 0; first < runs_.size(); first += fan_in) {
        const std::size_t count = std::min(fan_in, runs_.size() - first);
        longer.push_back(merge(std::span<const RunPlace>(runs_).subspan(first, count), merged));
      }
      spilled_ += file_->size();
      file_.emplace(std::move(merged));
      runs_ = std::move(longer);
    }
  }

  std::size_t reserve_fan_in() {
    std::uint64_t fan_in =
        std::clamp<std::uint64_t>(options_.allowance_bytes / kCursorBytes, 2, runs_.size() + 1);
    while (fan_in > 2 && !merge_charge_.try_resize((fan_in + 1) * kCursorBytes)) fan_in /= 2;
    fan_in = std::max<std::uint64_t>(fan_in, 2);
    merge_charge_.resize((fan_in + 1) * kCursorBytes);
    return static_cast<std::size_t>(fan_in);
  }

  RunPlace merge(std::span<const RunPlace> runs, RunFile& out) const {
    Merger merger(*file_, runs, Less());
    RunPlace place{out.size(), 0};
    std::vector<Record> block;
    std::vector<std::byte> packed;
    while (merger.front() != nullptr) {
      for (block.clear(); block.size() < kBlockRecords && merger.front() != nullptr; merger.pop())
        block.push_back(*merger.front());
      write_block(block, out, packed);
      ++place.blocks;
    }
    return place;
  }

  const char* owner_;
  const TempDir* temp_;
  SortOptions options_;
  std::size_t most_records_;
  Buffer filling_, writing_;
  Reservation merge_charge_;
  std::future<void> written_;
  std::optional<RunFile> file_;
  std::vector<RunPlace> runs_;
  std::optional<Merger> merger_;
  std::size_t at_ = 0;  // in filling_, when nothing was spilled
  std::uint64_t size_ = 0, spilled_ = 0;
};

}  // namespace reeb::ooc
