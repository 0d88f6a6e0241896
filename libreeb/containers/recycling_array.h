// An array whose elements are taken and freed, each named by its index. The index freed last is taken first; the free
// elements themselves form the list of free indices.
//
// The list leads from one element to another that may be anywhere in memory, so that following it is slow. The indices
// that were freed last are therefore kept in a small array, too.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/containers/growing_array.h"

namespace reeb {

// T has a member function next_free() that returns a std::uint32_t&. A free element holds a list link there.
template <class T>
class RecyclingArray {
 public:
  T& operator[](std::size_t i) { return elements_[i]; }
  const T& operator[](std::size_t i) const { return elements_[i]; }
  std::size_t size() const { return elements_.size(); }  // elements, including free ones
  std::span<const T> all() const { return elements_.all(); }
  std::size_t used() const { return elements_.size() - free_; }
  std::size_t memory_bytes() const { return elements_.memory_bytes() + 4 * recent_.capacity(); }

  // The index of an element that the caller sets.
  std::uint32_t take() {
    const std::uint32_t index = first_free_;
    if (index == kNone) {
      elements_.grow_by(1);
      return static_cast<std::uint32_t>(elements_.size() - 1);
    }
    --free_;
    if (recent_count_ < 2) {
      first_free_ = elements_[index].next_free();
      recent_count_ = 0;
      return index;
    }
    --recent_count_;
    --recent_end_;
    first_free_ = recent(1);
    prefetch_to_write(&elements_[recent(std::min(recent_count_, kTakesAhead))]);
    return index;
  }
  void free(std::uint32_t index) {
    elements_[index].next_free() = std::exchange(first_free_, index);
    ++free_;
    if (recent_.empty()) recent_.resize(kRecent);
    recent_[recent_end_++ % kRecent] = index;
    recent_count_ = std::min(recent_count_ + 1, kRecent);
  }

  void save(StateWriter& out) const {
    elements_.save(out);
    out.put(first_free_);
    out.put(std::uint64_t{free_});
  }
  void restore(StateReader& in) {
    elements_.restore(in);
    in.get(first_free_);
    free_ = static_cast<std::size_t>(in.get<std::uint64_t>());
    recent_count_ = 0;
  }
  // Which elements are free, of what was restored.
  // THROWS: DamagedState unless the list of free elements is one, and has as many as are said to be free.
  std::vector<bool> restored_free() {
    std::vector<bool> is_free(elements_.size());
    std::size_t count = 0;
    for (std::uint32_t i = first_free_; i != kNone; i = elements_[i].next_free(), ++count) {
      if (i >= elements_.size() || is_free[i]) throw DamagedState();
      is_free[i] = true;
    }
    if (count != free_) throw DamagedState();
    return is_free;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint32_t kRecent = 4096;   // a power of two
  static constexpr std::uint32_t kTakesAhead = 8;  // so far ahead is an element prefetched

  // The index that was freed last, last but one, ... REQUIRES: 1 <= i <= recent_count_.
  std::uint32_t recent(std::uint32_t i) const { return recent_[(recent_end_ - i) % kRecent]; }

  GrowingArray<T> elements_;
  std::uint32_t first_free_ = kNone;
  std::size_t free_ = 0;
  // The first recent_count_ of the list of free indices, backwards: recent_[i % kRecent] for i before recent_end_.
  std::vector<std::uint32_t> recent_;
  std::uint32_t recent_end_ = 0, recent_count_ = 0;
};

}  // namespace reeb
