// A hash map from 32-bit keys to small values in one flat array. Erasure leaves no tombstones: the tables over the
// front of a stream gain and lose keys without end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace reeb::io {

// Open addressing with linear probing, at most half full. Key ~0 is reserved.
template <class Value>
class FlatMap {
 public:
  std::size_t size() const { return size_; }

  // Null if absent. Valid until the next insertion or erasure.
  Value* find(std::uint32_t key) {
    if (entries_.empty()) return nullptr;
    const std::size_t at = locate(key);
    return entries_[at].key == key ? &entries_[at].value : nullptr;
  }

  // The value of `key`, made if absent.
  Value& operator[](std::uint32_t key) {
    if (2 * (size_ + 1) > entries_.size()) grow();
    const std::size_t at = locate(key);
    if (entries_[at].key != key) {
      entries_[at] = {key, Value{}};
      ++size_;
    }
    return entries_[at].value;
  }

  // REQUIRES: `key` is present.
  void erase(std::uint32_t key) {
    std::size_t hole = locate(key);
    for (std::size_t at = next(hole); entries_[at].key != kFree; at = next(at)) {
      // An entry can move back to the hole unless its home is after the hole.
      if (((at - home(entries_[at].key)) & mask()) < ((at - hole) & mask())) continue;
      entries_[hole] = std::move(entries_[at]);
      hole = at;
    }
    entries_[hole].key = kFree;
    --size_;
  }

 private:
  static constexpr std::uint32_t kFree = ~0u;
  struct Entry {
    std::uint32_t key = kFree;
    Value value{};
  };

  std::size_t mask() const { return entries_.size() - 1; }
  std::size_t next(std::size_t at) const { return (at + 1) & mask(); }
  std::size_t home(std::uint32_t key) const {
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 32) & mask();
  }
  std::size_t locate(std::uint32_t key) const {
    std::size_t at = home(key);
    while (entries_[at].key != key && entries_[at].key != kFree) at = next(at);
    return at;
  }
  void grow() {
    std::vector<Entry> old(entries_.empty() ? 64 : 2 * entries_.size());
    old.swap(entries_);
    for (Entry& entry : old)
      if (entry.key != kFree) entries_[locate(entry.key)] = std::move(entry);
  }

  std::vector<Entry> entries_;
  std::size_t size_ = 0;
};

}  // namespace reeb::io
