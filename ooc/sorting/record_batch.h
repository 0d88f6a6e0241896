// Records together with their payloads: bytes that sorting does not look at.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace reeb::ooc {

// The position of a record's payload in the pool of its batch.
struct PayloadPlace {
  std::uint32_t first = 0, size = 0;
};

template <class Record>
concept CarriesPayload = requires(Record record) {
  { (record.payload) } -> std::same_as<PayloadPlace&>;
};

// MEMORY: bytes(), and the spare capacity of the vectors. A pool has less than 4 GiB.
template <class Record>
struct RecordBatch {
  static_assert(std::is_trivially_copyable_v<Record>);

  std::vector<Record> records;
  std::vector<std::byte> pool;

  bool empty() const { return records.empty(); }
  std::size_t bytes() const { return records.size() * sizeof(Record) + pool.size(); }
  void clear() {
    records.clear();
    pool.clear();
  }

  std::span<const std::byte> payload(const Record& record) const {
    if constexpr (CarriesPayload<Record>)
      return std::span(pool).subspan(record.payload.first, record.payload.size);
    else
      return {};
  }
  void add(const Record& record, std::span<const std::byte> payload) {
    records.push_back(record);
    if constexpr (CarriesPayload<Record>) {
      records.back().payload = {static_cast<std::uint32_t>(pool.size()), static_cast<std::uint32_t>(payload.size())};
      pool.insert(pool.end(), payload.begin(), payload.end());
    }
  }
};

}  // namespace reeb::ooc
