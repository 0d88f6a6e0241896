// Blocks of sorted records, and a merger of the runs that they form.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ooc/sorting/rank_sort.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/sorting/sorted_run_file.h"

namespace reeb::ooc {

// Converts a block of sorted records to bytes: as it is in memory. Another codec has the same two functions. decode()
// returns false if the bytes are not a block of this many records. For records with payloads, encode() also takes the
// pool, and decode() fills one.
template <class Record>
struct PlainCodec {
  static_assert(!CarriesPayload<Record>);
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

// A block has about this many bytes of records and payloads, and at least one record.
inline constexpr std::size_t kRunBlockBytes = 64 << 10;

// How many of the first records make a block.
template <class Record>
std::size_t block_records(std::span<const Record> records) {
  const std::size_t most = std::min(kRunBlockBytes / sizeof(Record), records.size());
  if constexpr (CarriesPayload<Record>) {
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < most; ++i) {
      bytes += sizeof(Record) + records[i].payload.size;
      if (bytes > kRunBlockBytes) return std::max<std::size_t>(i, 1);
    }
  }
  return most;
}

// Appends all records to `file`, block after block. Returns the number of blocks.
template <class Record, class Codec>
std::uint64_t append_blocks(std::span<const Record> records, [[maybe_unused]] std::span<const std::byte> pool,
                            SortedRunFile& file) {
  std::uint64_t blocks = 0;
  for (std::vector<std::byte> packed; !records.empty(); ++blocks) {
    const auto block = records.first(block_records(records));
    packed.clear();
    if constexpr (CarriesPayload<Record>)
      Codec::encode(block, pool, packed);
    else
      Codec::encode(block, packed);
    file.append(packed, block.size());
    records = records.subspan(block.size());
  }
  return blocks;
}

// Unpacks a block of as many records as `block` has. False if the bytes are not such a block.
template <class Record, class Codec>
bool decode_block(std::span<const std::byte> packed, RecordBatch<Record>& block) {
  if (block.empty()) return false;
  if constexpr (CarriesPayload<Record>)
    return Codec::decode(packed, block.records, block.pool);
  else
    return Codec::decode(packed, block.records);
}

// Reads the next block of `run`, which must have one, and advances it. THROWS: as SortedRunFile, also for a block that
// cannot be decoded.
template <class Record, class Codec>
void read_block(const SortedRunFile& file, RunPlace& run, std::vector<std::byte>& packed, RecordBatch<Record>& block) {
  const std::uint64_t offset = run.offset;
  block.records.resize(file.read(run, packed));
  if (!decode_block<Record, Codec>(packed, block)) file.refuse(offset);
}

// 0 if there is no rank. Unequal ranks order most records without a branch that the processor cannot predict.
template <class Less, class Record>
std::uint64_t rank_of(const Record& record) {
  if constexpr (HasRank<Less, Record>)
    return Less::rank(record);
  else
    return 0;
}

// Merges the sorted runs of a file with a tree of losers: one comparison for each doubling of the number of runs. Of
// equal records, those of earlier runs come first. Holds one block of each run.
// REQUIRES: at least one run.
template <class Record, class Codec, class Less>
class SortedRunMerger {
 public:
  SortedRunMerger(const SortedRunFile& file, std::span<const RunPlace> runs)
      : file_(&file), cursors_(runs.size()), heads_(runs.size()), ranks_(runs.size()), losers_(runs.size()) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      cursors_[i].rest = runs[i];
      refill(i);
    }
    play_all();
  }

  bool empty() const { return heads_[winner_].place == nullptr; }

  // Moves the first record to the end of `out`. REQUIRES: !empty().
  void take(RecordBatch<Record>& out) {
    const Cursor& top = cursors_[winner_];
    Head& head = heads_[winner_];
    out.add(head.record, top.block.payload(head.record));
    if (++head.place == top.end) {
      refill(winner_);
    } else {
      head.record = *head.place;
      prefetch_payload(top.block, head.record);
      ranks_[winner_] = rank_of<Less>(head.record);
    }
    replay();
  }

 private:
  struct Cursor {
    RunPlace rest;
    RecordBatch<Record> block;  // the current one
    const Record* end = nullptr;
  };
  // The next record of a run, copied, so that comparing does not touch a block of each run. At the end of the run,
  // `place` is null.
  struct Head {
    Record record{};
    const Record* place = nullptr;
  };

  void refill(std::size_t i) {
    Cursor& cursor = cursors_[i];
    heads_[i].place = nullptr;
    ranks_[i] = std::numeric_limits<std::uint64_t>::max();
    if (cursor.rest.blocks == 0) return;
    read_block<Record, Codec>(*file_, cursor.rest, packed_, cursor.block);
    const std::vector<Record>& records = cursor.block.records;
    cursor.end = records.data() + records.size();
    heads_[i] = {records[0], records.data()};
    ranks_[i] = rank_of<Less>(records[0]);
  }

  // The payload is read when the record wins; it was not touched since its block was unpacked.
  static void prefetch_payload([[maybe_unused]] const RecordBatch<Record>& block,
                               [[maybe_unused]] const Record& record) {
    if constexpr (CarriesPayload<Record>) __builtin_prefetch(block.pool.data() + record.payload.first);
  }

  // A total order of the runs that have records left; exhausted runs come after them.
  bool beats(std::size_t a, std::size_t b) const {
    return ranks_[a] != ranks_[b] ? ranks_[a] < ranks_[b] : beats_of_equal_rank(a, b);
  }
  bool beats_of_equal_rank(std::size_t a, std::size_t b) const {
    const Head &x = heads_[a], &y = heads_[b];
    if (x.place == nullptr || y.place == nullptr) return x.place != nullptr;
    return a < b ? !Less()(y.record, x.record) : Less()(x.record, y.record);
  }

  // Run i is leaf n + i of a tree with the inner nodes 1 .. n - 1; node i has the children 2i, 2i + 1.
  void play_all() {
    const std::size_t n = heads_.size();
    std::vector<std::size_t> winners(2 * n);
    for (std::size_t i = 0; i < n; ++i) winners[n + i] = i;
    for (std::size_t node = n; node-- > 1;) {
      std::size_t winner = winners[2 * node], loser = winners[2 * node + 1];
      if (beats(loser, winner)) std::swap(winner, loser);
      winners[node] = winner;
      losers_[node] = loser;
    }
    winner_ = winners[1];
  }

  void replay() {
    std::size_t winner = winner_;
    for (std::size_t node = (winner + heads_.size()) / 2; node != 0; node /= 2) {
      const std::size_t other = losers_[node];
      const bool loses = beats(other, winner);
      losers_[node] = loses ? winner : other;
      winner = loses ? other : winner;
    }
    winner_ = winner;
  }

  const SortedRunFile* file_;
  std::vector<std::byte> packed_;
  std::vector<Cursor> cursors_;
  std::vector<Head> heads_;           // by run
  std::vector<std::uint64_t> ranks_;  // of the heads; the greatest value at a run's end
  std::vector<std::size_t> losers_;   // by inner node: who lost there
  std::size_t winner_ = 0;
};

}  // namespace reeb::ooc
