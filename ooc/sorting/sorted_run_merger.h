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

#include "libreeb/base/prefetch.h"
#include "ooc/sorting/rank_sort.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/sorting/sorted_run_file.h"

namespace reeb::ooc {

// Converts a block of sorted records to bytes: as it is in memory. Another codec has the same two functions. decode()
// returns false if the bytes are not a block of this many records. For records with payloads, encode() also takes the
// pool, and decode() fills one.
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

// The payloads follow the records.
template <CarriesPayload Record>
struct PlainCodec<Record> {
  static void encode(std::span<const Record> records, std::span<const std::byte> pool, std::vector<std::byte>& packed) {
    const auto bytes = std::as_bytes(records);
    packed.assign(bytes.begin(), bytes.end());
    for (const Record& record : records) {
      const auto payload = pool.subspan(record.payload.first, record.payload.size);
      packed.insert(packed.end(), payload.begin(), payload.end());
    }
  }
  static bool decode(std::span<const std::byte> packed, std::span<Record> records, std::vector<std::byte>& pool) {
    if (packed.size() < records.size_bytes()) return false;
    std::memcpy(records.data(), packed.data(), records.size_bytes());
    const auto payloads = packed.subspan(records.size_bytes());
    pool.assign(payloads.begin(), payloads.end());
    std::size_t first = 0;
    for (Record& record : records) {
      record.payload.first = static_cast<std::uint32_t>(first);
      first += record.payload.size;
    }
    return first == pool.size();
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
      : file_(&file), cursors_(runs.size()), heads_(runs.size()), losers_(runs.size()) {
    for (std::size_t i = 0; i < runs.size(); ++i) cursors_[i].rest = runs[i];
    play_all();
  }

  bool empty() const { return heads_[winner_.run].place == nullptr; }

  // Moves the first record to the end of `out`. REQUIRES: !empty().
  void take(RecordBatch<Record>& out) {
    const std::size_t i = winner_.run;
    const Cursor& top = cursors_[i];
    Head& head = heads_[i];
    out.add(head.record, top.block.payload(head.record));
    if (head.place + 1 == top.end) {
      winner_.rank = refill(i);
    } else {
      ++head.place;
      head.record = *head.place;
      prefetch_after(top.block, head);
      winner_.rank = rank_of<Less>(head.record);
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
  // A run, and the rank of its head; the greatest value at the run's end.
  struct Player {
    std::uint64_t rank, run;
  };

  // Replaces the head of run i by the first record of its next block; returns the rank.
  std::uint64_t refill(std::size_t i) {
    Cursor& cursor = cursors_[i];
    heads_[i].place = nullptr;
    if (cursor.rest.blocks == 0) return std::numeric_limits<std::uint64_t>::max();
    read_block<Record, Codec>(*file_, cursor.rest, packed_, cursor.block);
    const std::vector<Record>& records = cursor.block.records;
    cursor.end = records.data() + records.size();
    heads_[i] = {records[0], records.data()};
    return rank_of<Less>(records[0]);
  }

  // The next record of the run is read when this one wins, and so is the payload of this one. Neither was touched since
  // the block was unpacked, and the blocks of all runs together do not fit the caches. Their first bytes are next to
  // what was read last, so the last ones are fetched.
  static void prefetch_after([[maybe_unused]] const RecordBatch<Record>& block, const Head& head) {
    prefetch(reinterpret_cast<const std::byte*>(head.place + 2) - 1);
    if constexpr (CarriesPayload<Record>)
      if (const auto [first, size] = head.record.payload; size != 0) prefetch(block.pool.data() + first + size - 1);
  }

  // A total order of the runs that have records left; exhausted runs come after them.
  bool beats(const Player& a, const Player& b) const {
    return a.rank < b.rank || (a.rank == b.rank && beats_of_equal_rank(a.run, b.run));
  }
  bool beats_of_equal_rank(std::size_t a, std::size_t b) const {
    const Head &x = heads_[a], &y = heads_[b];
    if (x.place == nullptr || y.place == nullptr) return x.place != nullptr;
    return a < b ? !Less()(y.record, x.record) : Less()(x.record, y.record);
  }

  // Run i is leaf n + i of a tree with the inner nodes 1 .. n - 1; node i has the children 2i, 2i + 1.
  void play_all() {
    const std::size_t n = heads_.size();
    std::vector<Player> winners(2 * n);
    for (std::size_t i = 0; i < n; ++i) winners[n + i] = {refill(i), i};
    for (std::size_t node = n; node-- > 1;) {
      winners[node] = winners[2 * node];
      losers_[node] = winners[2 * node + 1];
      if (beats(losers_[node], winners[node])) std::swap(losers_[node], winners[node]);
    }
    winner_ = winners[1];
  }

  // Who wins cannot be predicted, so the processor must not have to: no branch depends on it.
  void replay() {
    auto [rank, run] = winner_;
    for (std::size_t node = (run + heads_.size()) / 2; node != 0; node /= 2) {
      const Player other = losers_[node];
      bool loses = other.rank < rank;
      if (other.rank == rank) [[unlikely]]
        loses = beats_of_equal_rank(other.run, run);
      losers_[node].rank = loses ? rank : other.rank;
      losers_[node].run = loses ? run : other.run;
      rank = loses ? other.rank : rank;
      run = loses ? other.run : run;
    }
    winner_ = {rank, run};
  }

  const SortedRunFile* file_;
  std::vector<std::byte> packed_;
  std::vector<Cursor> cursors_;
  std::vector<Head> heads_;     // by run
  std::vector<Player> losers_;  // by inner node: who lost there
  Player winner_{};
};

}  // namespace reeb::ooc
