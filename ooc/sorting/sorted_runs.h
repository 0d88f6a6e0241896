// The sorted runs of an external sort, in one file.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/state_stream.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/sorting/sorted_run_file.h"
#include "ooc/sorting/sorted_run_merger.h"
#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {

// How much of a block a scan unpacks.
enum class Unpack { kNothing, kKeys, kAll };

// THROWS: as SortedRunFile, from every call that reads or writes.
// THREADS: one writer or many readers.
template <class Record, class Codec, class Less>
class SortedRuns {
 public:
  using Batch = RecordBatch<Record>;
  using Merger = SortedRunMerger<Record, Codec, Less>;

  bool empty() const { return runs_.empty(); }
  std::size_t count() const { return runs_.size(); }
  // Bytes written so far, including merging passes.
  std::uint64_t written_bytes() const { return replaced_bytes_ + (file_ ? file_->size() : 0); }

  bool has_file() const { return file_.has_value(); }
  void set_file(io::File file) { file_.emplace(std::move(file)); }
  // REQUIRES: there is a file; the records are in order.
  void append(const Batch& run) {
    RunPlace place{file_->size(), 0};
    place.blocks = append_blocks<Record, Codec>(run.records, run.pool, *file_);
    runs_.push_back(place);
  }

  // For another process: once the runs are on the device.
  void save(StateWriter& out) const {
    if (file_) file_->sync();
    out.put_array(runs_);
    out.put(file_ ? file_->manifest() : RunManifest{});
  }
  // `path` is the file that the other process set. Returns the number of records.
  // THROWS: DamagedState or Error if it is missing or has changed.
  std::uint64_t restore(StateReader& in, const std::string& path) {
    in.get_array(runs_);
    const auto manifest = in.get<RunManifest>();
    if (!runs_.empty()) file_.emplace(io::File::open_for_update(path), manifest);
    if (file_ ? !file_->consists_of(runs_) : manifest != RunManifest{}) throw DamagedState();
    return manifest.records;
  }

  // The records of all runs in order. REQUIRES: there is a run; there is no other change while it is used.
  std::unique_ptr<Merger> merger() const { return std::make_unique<Merger>(*file_, runs_); }

  // Merges `fan_in` runs into one, in passes until there are no more than so many. Each pass writes to a file that
  // create_file() returns. `poll` is called for every block.
  template <class CreateFile>
  void reduce(std::size_t fan_in, const CreateFile& create_file, const std::function<void()>& poll) {
    while (runs_.size() > fan_in) {
      SortedRunFile merged(create_file());
      std::vector<RunPlace> longer;
      for (std::size_t first = 0; first < runs_.size(); first += fan_in) {
        const std::size_t some = std::min(fan_in, runs_.size() - first);
        longer.push_back(merge(std::span<const RunPlace>(runs_).subspan(first, some), merged, poll));
      }
      replaced_bytes_ += file_->size();
      file_.emplace(std::move(merged));
      runs_ = std::move(longer);
    }
  }

  // Calls look(records) for all blocks, in several threads if `background`, with only the sort keys filled in; and
  // visit(batch), one at a time, for the blocks for which look() returned more than kNothing. `poll` is called for
  // every block, in any of the threads, but never in two at once.
  template <class Look, class Visit>
  void scan(bool background, const Look& look, const Visit& visit, const std::function<void()>& poll) const {
    struct Block {
      std::uint64_t offset = 0;
      std::vector<std::byte> packed;
      Batch batch;
      Unpack wanted = Unpack::kNothing;
    };
    auto run = runs_.begin();
    RunPlace place = *run;
    const auto read_next = [&](Block& block) {
      if (place.blocks == 0 && ++run == runs_.end()) return false;
      if (place.blocks == 0) place = *run;
      block.offset = place.offset;
      block.batch.records.resize(file_->read(place, block.packed));
      return true;
    };
    const auto unpack = [&](Block& block) {
      auto& [records, pool] = block.batch;
      pool.clear();
      bool is_block = Codec::decode_keys(block.packed, records);
      block.wanted = is_block ? look(std::span(std::as_const(records))) : Unpack::kNothing;
      if (block.wanted == Unpack::kAll) is_block = decode_block<Record, Codec>(block.packed, block.batch);
      if (!is_block) file_->refuse(block.offset);
    };
    read_ahead<Block>(background, read_next, unpack, [&](const Block& block) {
      if (poll) poll();
      if (block.wanted != Unpack::kNothing) visit(block.batch);
    });
  }

 private:
  RunPlace merge(std::span<const RunPlace> runs, SortedRunFile& out, const std::function<void()>& poll) const {
    Merger merger(*file_, runs);
    RunPlace place{out.size(), 0};
    for (Batch block; !merger.empty();) {
      if (poll) poll();
      block.clear();
      while (!merger.empty() && block.bytes() + sizeof(Record) <= kRunBlockBytes) merger.take(block);
      place.blocks += append_blocks<Record, Codec>(block.records, block.pool, out);
    }
    return place;
  }

  std::optional<SortedRunFile> file_;
  std::vector<RunPlace> runs_;
  std::uint64_t replaced_bytes_ = 0;  // of the files before
};

}  // namespace reeb::ooc
