// Sorts more records than memory holds: sorted runs on disk, merged while they are read back.
#pragma once

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/state_stream.h"
#include "ooc/sorting/rank_sort.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/sorting/sort_buffer.h"
#include "ooc/sorting/sorted_run_merger.h"
#include "ooc/sorting/sorted_runs.h"
#include "ooc/threads/kept_arena.h"
#include "ooc/threads/worker.h"

namespace reeb::ooc {

struct SortOptions {
  std::uint64_t allowance_bytes = 16 << 20;  // of the budget
  std::uint64_t most_bytes = 0;              // if larger: the allowance grows with the file, up to this
  unsigned threads = 1;                      // that sort a run
  bool background = false;                   // sort and write runs in a separate thread, with half the buffer
  std::string file = {};                     // of the runs, so that another process can resume; empty: unnamed
  // Called for every block that is scanned, in one thread at a time. It may throw to stop.
  std::function<void()> poll = {};
};

// add() any number of records, finish(), then read() them in order; rewind() starts over. While all records fit in the
// allowance, no file is made. Records with payloads that Less finds equal come out in the order in which they were
// added.
//
// THROWS: Error{kResource} of the budget or the disk. An error in the background is thrown by the next call and by
//         every later one, since records are lost.
// MEMORY: the allowance, reserved as it is needed, and a few blocks of 64 KiB. A payload that is larger than the
//         allowance gets the memory it needs. An allowance that grows is a sixth of the bytes on disk, so that a
//         large file does not have too many runs: merging holds a block of each.
// THREADS: one at a time.
template <class Record, class Codec = PlainCodec<Record>, class Less = std::less<Record>>
class ExternalSort {
 public:
  using Batch = RecordBatch<Record>;
  static constexpr std::size_t kBlockRecords = kRunBlockBytes / sizeof(Record);

  // `owner` is a string literal for the budget's texts; `temp` and `budget` must outlive this.
  ExternalSort(const char* owner, const io::TempDir& temp, MemoryBudget& budget, const SortOptions& options = {})
      : owner_(owner),
        temp_(&temp),
        options_(options),
        most_bytes_(std::max<std::uint64_t>(kBlockRecords * sizeof(Record),
                                            options.allowance_bytes / (options.background ? 2 : 1))),
        filling_{{}, budget.reserve(owner, 0)},
        writing_{{}, budget.reserve(owner, 0)},
        merge_charge_(budget.reserve(owner, 0)) {}
  ExternalSort(const ExternalSort&) = delete;
  ExternalSort& operator=(const ExternalSort&) = delete;

  void add(std::span<const Record> records) {
    size_ += records.size();
    while (!records.empty()) {
      auto& buffer = filling_.batch.records;
      if (buffer.size() == filling_.room && !grow_records()) flush();
      const std::size_t count = std::min(records.size(), filling_.room - buffer.size());
      buffer.insert(buffer.end(), records.begin(), records.begin() + static_cast<std::ptrdiff_t>(count));
      records = records.subspan(count);
    }
  }
  void add(const Record& record) { add(std::span(&record, 1)); }

  void add(const Record& record, std::span<const std::byte> payload) requires CarriesPayload<Record> {
    largest_payload_ = std::max<std::uint64_t>(largest_payload_, payload.size());
    ++size_;
    if ((filling_.batch.records.size() == filling_.room && !grow_records()) ||
        !filling_.grow_pool(payload.size(), most_bytes_)) {
      flush();
      if (!filling_.grow_pool(payload.size(), most_bytes_)) filling_.replace_pool(payload.size());
    }
    filling_.batch.add(record, payload);
  }

  // Saves all that was added so far, for another process: the runs, once they are on the device, and the records still
  // in memory.
  // REQUIRES: a named file; finish() was not called.
  void save(StateWriter& out) {
    wait_for_writer();
    runs_.save(out);
    out.put(largest_payload_);
    out.put_array(filling_.batch.records);
    out.put_array(filling_.batch.pool);
  }
  // REQUIRES: a named file; nothing was added yet.
  // THROWS: DamagedState or Error if the file of the runs is missing or has changed, or if is_sound(record) is false
  //         for a record that was in memory.
  template <class Sound>
  void restore(StateReader& in, const Sound& is_sound) {
    size_ = runs_.restore(in, options_.file);
    in.get(largest_payload_);
    if (largest_payload_ > ~std::uint32_t{0}) throw DamagedState();
    Batch rest;
    in.get_array(rest.records);
    in.get_array(rest.pool);
    if (!std::ranges::all_of(rest.records, is_sound)) throw DamagedState();
    if constexpr (CarriesPayload<Record>) {
      for (const Record& record : rest.records) {
        if (record.payload.first > rest.pool.size() || record.payload.size > rest.pool.size() - record.payload.first)
          throw DamagedState();
        add(record, rest.payload(record));
      }
    } else {
      add(rest.records);
    }
  }

  // Ends adding. Merges runs until the remaining ones can be merged while they are read, within `merge_bytes` of the
  // budget (0: the allowance), or less if the budget has less. `poll` is called for every block that is merged.
  void finish(std::uint64_t merge_bytes = 0, const std::function<void()>& poll = {}) {
    wait_for_writer();
    if (runs_.empty()) {
      sort(filling_.batch.records);
    } else {
      flush();
      wait_for_writer();
      filling_.free();
      writing_.free();
      const std::size_t fan_in = reserve_fan_in(merge_bytes == 0 ? options_.allowance_bytes : merge_bytes);
      runs_.reduce(
          fan_in, [this] { return temp_->create_unnamed(owner_); }, poll);
    }
    rewind();
  }

  std::uint64_t reserved_bytes() const {
    return filling_.charge.bytes() + writing_.charge.bytes() + merge_charge_.bytes();
  }

  // Starts again from the first record. REQUIRES: finish() was called.
  void rewind() {
    at_ = 0;
    merger_.reset();
    merge_charge_.resize(merge_bytes_);
  }
  // Gives the memory for merging back; rewind() reserves it again. REQUIRES: finish() was called, and nothing is read
  // until rewind() is. Scans are allowed.
  void set_aside() {
    merger_.reset();
    merge_charge_.resize(0);
  }

  // Replaces `out` by the next records in order: at most `limit`, fewer if their payloads exceed `payload_limit` bytes.
  // False at the end.
  bool read(Batch& out, std::size_t limit, std::size_t payload_limit = kRunBlockBytes) {
    out.clear();
    const auto is_full = [&] { return out.records.size() == limit || out.pool.size() > payload_limit; };
    if (runs_.empty()) {
      const Batch& all = filling_.batch;
      for (; !is_full() && at_ < size_; ++at_) out.add(all.records[at_], all.payload(all.records[at_]));
    } else if (at_ < size_) {
      // Blocks are in memory only from the first record to the last.
      if (!merger_) merger_ = runs_.merger();
      for (; !is_full() && !merger_->empty(); ++at_) merger_->take(out);
      if (merger_->empty()) merger_.reset();
    }
    return !out.empty();
  }
  bool read(std::vector<Record>& out, std::size_t limit) requires(!CarriesPayload<Record>) {
    Batch batch;
    batch.records.swap(out);
    const bool some = read(batch, limit);
    batch.records.swap(out);
    return some;
  }

  // Scans are for callers that need no order: they cost a fraction of merging. The order is unspecified, except that
  // records that Less finds equal come in the order of adding. A scan may be called between any reads.
  // REQUIRES: finish() was called.   MEMORY: three blocks.

  // Calls visit(record) for all records. Only the sort key of a record is filled in.
  template <class Visit>
  void scan_keys(const Visit& visit) const {
    scan_blocks([](std::span<const Record>) { return Unpack::kKeys; },
                [&](const Batch& block) { std::ranges::for_each(block.records, visit); });
  }
  // Calls visit(record, batch) for records for which wanted(record) is true. `batch` holds the record's payload.
  // `wanted` sees the sort key only and is called concurrently. A block with no wanted record is decoded only as far as
  // its keys.
  template <class Predicate, class Visit>
  void scan(const Predicate& wanted, const Visit& visit) const {
    scan_blocks(
        [&](std::span<const Record> records) {
          return std::ranges::any_of(records, wanted) ? Unpack::kAll : Unpack::kNothing;
        },
        [&](const Batch& block) {
          for (const Record& record : block.records)
            if (wanted(record)) visit(record, block);
        });
  }

  // The order in which the records of a batch come out: payload positions in the pool ascend in the order of adding.
  static bool in_order(const Record& a, const Record& b) {
    if constexpr (CarriesPayload<Record>) {
      if (Less()(a, b)) return true;
      if (Less()(b, a)) return false;
      return a.payload.first < b.payload.first ||
             (a.payload.first == b.payload.first && a.payload.size < b.payload.size);
    } else {
      return Less()(a, b);
    }
  }

  std::uint64_t size() const { return size_; }
  // Bytes written so far, including merging passes.
  std::uint64_t spilled_bytes() const { return runs_.written_bytes(); }

 private:
  using Runs = SortedRuns<Record, Codec, Less>;
  using Buffer = SortBuffer<Record>;

  // As SortedRuns::scan(); records in memory are one block.
  template <class Look, class Visit>
  void scan_blocks(const Look& look, const Visit& visit) const {
    if (!runs_.empty()) return runs_.scan(options_.background, look, visit, options_.poll);
    if (look(std::span(filling_.batch.records)) != Unpack::kNothing) visit(filling_.batch);
  }

  bool grow_records() {
    if (filling_.room != 0) return filling_.grow_records(kBlockRecords, most_bytes_);
    filling_.start(kBlockRecords);
    return true;
  }

  void flush() {
    wait_for_writer();
    if (filling_.batch.empty()) return;
    if (!runs_.has_file())
      runs_.set_file(options_.file.empty() ? temp_->create_unnamed(owner_) : io::File::create(options_.file));
    grow_allowance();  // while no writer changes the size of the file
    std::swap(filling_, writing_);
    if (options_.background) {
      writer_.start([this] { write_run(writing_.batch); });
    } else {
      write_run(writing_.batch);
      std::swap(filling_, writing_);
    }
    // If the budget is too small for a second buffer, wait for the first.
    if (filling_.room == 0 && !filling_.try_start(kBlockRecords)) {
      wait_for_writer();
      std::swap(filling_, writing_);
    }
  }

  void grow_allowance() {
    constexpr std::uint64_t kShare = 6;
    const std::uint64_t bytes = std::min(spilled_bytes() / kShare, options_.most_bytes);
    most_bytes_ = std::max(most_bytes_, bytes / (options_.background ? 2 : 1));
  }

  void wait_for_writer() {
    try {
      writer_.wait();
    } catch (...) {
      failure_ = std::current_exception();
    }
    if (failure_) std::rethrow_exception(failure_);
  }

  void sort(std::vector<Record>& records) const {
    const auto less = [](const Record& a, const Record& b) { return in_order(a, b); };
    if constexpr (HasRank<Less, Record>) {
      sort_by_rank(
          std::span(records), [](const Record& r) { return Less::rank(r); }, less, options_.threads);
      return;
    }
#ifdef __SANITIZE_THREAD__
    constexpr bool kVisibleToSanitizer = false;  // the sanitizer does not see TBB pass records between threads
#else
    constexpr bool kVisibleToSanitizer = true;
#endif
    if (options_.threads > 1 && kVisibleToSanitizer)
      run_in_kept_arena(options_.threads, [&] { tbb::parallel_sort(records.begin(), records.end(), less); });
    else
      std::sort(records.begin(), records.end(), less);
  }

  void write_run(Batch& batch) {
    sort(batch.records);
    runs_.append(batch);
    batch.clear();
  }

  // How many runs are merged at once. A run that is being merged holds one block; packing and unpacking take the same
  // again.
  std::size_t reserve_fan_in(std::uint64_t merge_bytes) {
    const std::uint64_t cursor = kRunBlockBytes + largest_payload_, rest = 4 * cursor;
    std::uint64_t fan_in = std::clamp<std::uint64_t>((merge_bytes - std::min(merge_bytes, rest)) / cursor, 2,
                                                     std::max<std::uint64_t>(runs_.count(), 2));
    while (fan_in > 2 && !merge_charge_.try_resize(fan_in * cursor + rest))
      fan_in = std::max<std::uint64_t>(2, fan_in / 2);
    merge_bytes_ = fan_in * cursor + rest;
    merge_charge_.resize(merge_bytes_);
    return static_cast<std::size_t>(fan_in);
  }

  const char* owner_;
  const io::TempDir* temp_;
  SortOptions options_;
  std::uint64_t most_bytes_;  // of a buffer
  Buffer filling_, writing_;
  Reservation merge_charge_;
  std::uint64_t merge_bytes_ = 0;  // that merging takes
  std::exception_ptr failure_;     // of the writer; every later call throws it
  Runs runs_;
  std::unique_ptr<typename Runs::Merger> merger_;
  std::uint64_t at_ = 0;  // records read so far
  std::uint64_t size_ = 0, largest_payload_ = 0;
  Worker writer_;  // sorts and writes writing_; the last member, so that it is destroyed first
};

}  // namespace reeb::ooc
