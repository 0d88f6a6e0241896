// A hash map from 64-bit keys to 32-bit values in two flat arrays.
//
// Linear probing, at most half full, deletion by shifting back: no tombstones, no nodes, one
// allocation when it grows. Iteration order is not defined, and nothing may depend on it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/prefetch.h"

namespace reeb {

class FlatMap {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::size_t size() const { return size_; }
  std::size_t memory_bytes() const { return keys_.capacity() * 8 + values_.capacity() * 4; }

  // The most bytes that inserting `keys` more keys takes in addition: arrays that grow are copied.
  std::size_t growth_bytes(std::size_t keys) const {
    const std::size_t most = 2 * (size_ + keys);
    return most <= values_.size() ? 0 : std::bit_ceil(most) * (8 + 4);
  }

  // To be called some time before another function with this key, so that its entry arrives in the cache meanwhile.
  void prefetch(std::uint64_t key) const {
    if (values_.empty()) return;
    reeb::prefetch(&values_[home(key)]);
    reeb::prefetch(&keys_[home(key)]);
  }

  // The value of `key`, or kNone.
  std::uint32_t find(std::uint64_t key) const {
    if (size_ == 0) return kNone;
    for (std::size_t i = home(key);; i = (i + 1) & mask_) {
      if (values_[i] == kNone) return kNone;
      if (keys_[i] == key) return values_[i];
    }
  }

  // The value of `key`; `value` is inserted first if there was none.
  // REQUIRES: value != kNone.
  std::uint32_t find_or_insert(std::uint64_t key, std::uint32_t value) {
    if (2 * (size_ + 1) > values_.size()) grow();
    std::size_t i = home(key);
    for (; values_[i] != kNone; i = (i + 1) & mask_)
      if (keys_[i] == key) return values_[i];
    keys_[i] = key;
    values_[i] = value;
    ++size_;
    return value;
  }

  // Removes `key` if it is present.
  void erase(std::uint64_t key) {
    if (size_ == 0) return;
    std::size_t i = home(key);
    for (;; i = (i + 1) & mask_) {
      if (values_[i] == kNone) return;
      if (keys_[i] == key) break;
    }
    // Close the gap: a later entry moves back into it unless the entry's home is after the gap.
    for (std::size_t j = (i + 1) & mask_; values_[j] != kNone; j = (j + 1) & mask_) {
      if (((j - home(keys_[j])) & mask_) >= ((j - i) & mask_)) {
        keys_[i] = keys_[j];
        values_[i] = values_[j];
        i = j;
      }
    }
    values_[i] = kNone;
    --size_;
  }

  // Forgets all entries; keeps the memory.
  void clear() {
    if (size_ != 0) values_.assign(values_.size(), kNone);
    size_ = 0;
  }

 private:
  std::size_t home(std::uint64_t key) const { return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> shift_); }

  void grow() {
    std::vector<std::uint64_t> keys(values_.empty() ? 16 : 2 * values_.size());
    std::vector<std::uint32_t> values(keys.size(), kNone);
    keys.swap(keys_);
    values.swap(values_);
    mask_ = keys_.size() - 1;
    --shift_;
    if (values.empty()) shift_ = 60;
    size_ = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] != kNone) find_or_insert(keys[i], values[i]);
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;  // kNone: free
  std::size_t size_ = 0, mask_ = 0;
  unsigned shift_ = 64;
};

}  // namespace reeb
