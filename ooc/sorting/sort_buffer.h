// The records in memory before they are sorted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "ooc/sorting/record_batch.h"

namespace reeb::ooc {

// A batch that grows within an allowance and the budget. It grows by a quarter at least: an allowance may rise a little
// after every run. While it is copied to new memory, the old and the new memory both exist, and both are reserved.
template <class Record>
struct SortBuffer {
  RecordBatch<Record> batch;
  Reservation charge;
  // The number of records that are reserved. The vector may have room for more: pages that it does not use take no
  // memory, and as it grows into them, nothing is copied to pages that are new to the process.
  std::size_t room = 0;

  void free() {
    batch = {};
    room = 0;
    charge.resize(0);
  }

  // Makes room for the first records. THROWS: Error{kResource}.
  void start(std::size_t records) {
    charge.resize(bytes(records, batch.pool.capacity()));
    batch.records.reserve(records);
    room = records;
  }
  // The same, but returns false if the budget does not allow it.
  bool try_start(std::size_t records) {
    if (!charge.try_resize(records * sizeof(Record))) return false;
    batch.records.reserve(records);
    room = records;
    return true;
  }

  // Doubles the room for records, to at least `least`, within `most_bytes` for records and pool together.
  bool grow_records(std::size_t least, std::uint64_t most_bytes) {
    auto& [records, pool] = batch;
    const std::uint64_t left = most_bytes - std::min<std::uint64_t>(most_bytes, pool.capacity());
    const std::size_t after = std::min(static_cast<std::size_t>(left / sizeof(Record)), std::max(least, 2 * room));
    const std::size_t copied = after > records.capacity() ? room : 0;
    if (!is_worth_it(room, after) || !charge.try_resize(bytes(copied + after, pool.capacity()))) return false;
    if (copied != 0) records.reserve(std::max(after, kUnusedBytes / sizeof(Record)));
    room = after;
    charge.resize(bytes(room, pool.capacity()));
    return true;
  }

  // The same for the pool, if it must grow for `more` bytes.
  bool grow_pool(std::size_t more, std::uint64_t most_bytes) {
    std::vector<std::byte>& pool = batch.pool;
    const std::size_t needed = pool.size() + more, before = pool.capacity();
    if (needed <= before) return true;
    const std::uint64_t held = bytes(room, 0);
    const std::uint64_t left = most_bytes - std::min(most_bytes, held);
    const auto after =
        static_cast<std::size_t>(std::min<std::uint64_t>(left, std::max<std::uint64_t>(needed, 2 * before)));
    if (after < needed || !is_worth_it(before, after) || !charge.try_resize(held + before + after)) return false;
    pool.reserve(after);
    charge.resize(held + pool.capacity());
    return true;
  }

  // For the first payload of a run, which must be stored whatever its size. REQUIRES: the pool is empty.
  void replace_pool(std::size_t size) {
    std::vector<std::byte>& pool = batch.pool;
    std::vector<std::byte>().swap(pool);
    charge.resize(bytes(room, size));
    pool.reserve(size);
  }

 private:
  // Larger blocks may be given huge pages, which are resident as a whole.
  static constexpr std::size_t kUnusedBytes = 3 << 20;

  static bool is_worth_it(std::size_t before, std::size_t after) { return after > before + before / 4; }
  static std::uint64_t bytes(std::size_t records, std::size_t pool) { return records * sizeof(Record) + pool; }
};

}  // namespace reeb::ooc
