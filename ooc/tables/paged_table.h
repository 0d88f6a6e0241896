// One entry per vertex, for more vertices than memory holds.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "ooc/tables/page_cache.h"

namespace reeb::ooc {

// A table of T, indexed from 0 without an upper limit. An entry that was never set has the fill value and costs
// nothing. Where nearly all entries get the same value in the end, that can be given as `usual`: pages of nothing else
// cost nothing on disk. A hit is a shift, three loads and a mark, about 2 ns. A miss reads a page, and might write one.
// Made for accesses that are mostly near each other.
//
// THROWS: Error{kResource} if the disk is full, or the budget lacks the smallest working set.
// MEMORY: as PageCache.   THREADS: one at a time.
template <class T>
class PagedTable {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(alignof(T) <= 16 && sizeof(T) <= PageCache::kPageBytes);

 public:
  static constexpr unsigned kShift = std::bit_width(PageCache::kPageBytes / sizeof(T)) - 1;
  static constexpr std::size_t kPageEntries = std::size_t{1} << kShift;

  PagedTable(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
             const T& fill)
      : cache_(owner, temp, budget, allowance_bytes, std::as_bytes(std::span(&fill, 1))) {}
  // REQUIRES: the size of T is a power of two.
  PagedTable(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
             const T& fill, const T& usual)
      : cache_(owner, temp, budget, allowance_bytes, std::as_bytes(std::span(&fill, 1)),
               std::as_bytes(std::span(&usual, 1))) {
    static_assert(std::has_single_bit(sizeof(T)), "else a page ends with a part of an entry");
  }

  T get(std::uint64_t index) { return entry(index, false); }
  void set(std::uint64_t index, const T& value) { entry(index, true) = value; }
  // The entry to change in place; valid until the next call.
  T& change(std::uint64_t index) { return entry(index, true); }

  // Calls visit(k, entry) for the entry of each id, to change it in place. Faster than change() if many ids in a row
  // are near each other.
  template <class Id, class Visit>
  void change_each(std::span<const Id> ids, const Visit& visit) {
    std::uint64_t page = ~std::uint64_t{0};
    T* entries = nullptr;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const std::uint64_t index = ids[k].value();
      if (index >> kShift != page) {
        page = index >> kShift;
        entries = &entry(page << kShift, true);
      }
      visit(k, entries[index & (kPageEntries - 1)]);
    }
  }

  // out[k] = entry first + k.
  void read(std::uint64_t first, std::span<T> out) {
    while (!out.empty()) {
      const std::size_t count = std::min(out.size(), run_length(first));
      std::copy_n(&entry(first, false), count, out.data());
      first += count;
      out = out.subspan(count);
    }
  }

  // Entry first + k = values[k].
  void write(std::uint64_t first, std::span<const T> values) {
    while (!values.empty()) {
      const std::size_t count = std::min(values.size(), run_length(first));
      std::copy_n(values.data(), count, &entry(first, true));
      first += count;
      values = values.subspan(count);
    }
  }

  // The first entry from `index` to before `end` that may have been set; `end` if there is none.
  std::uint64_t next_set(std::uint64_t index, std::uint64_t end) const {
    while (index < end && cache_.is_fresh(static_cast<std::size_t>(index >> kShift)))
      index = ((index >> kShift) + 1) << kShift;
    return std::min(index, end);
  }

  // The first entry from `index` to before `end` that may differ from `usual`; `end` if there is none.
  std::uint64_t next_unusual(std::uint64_t index, std::uint64_t end) const {
    while (index < end && cache_.is_usual(static_cast<std::size_t>(index >> kShift)))
      index = ((index >> kShift) + 1) << kShift;
    return std::min(index, end);
  }

  const PageCache& pages() const { return cache_; }
  PageCache& pages() { return cache_; }

 private:
  // Entries from `index` to the end of its page.
  static std::size_t run_length(std::uint64_t index) {
    return kPageEntries - static_cast<std::size_t>(index % kPageEntries);
  }

  T& entry(std::uint64_t index, bool writing) {
    std::byte* page = cache_.page(static_cast<std::size_t>(index >> kShift), writing);
    return reinterpret_cast<T*>(page)[index & (kPageEntries - 1)];
  }

  PageCache cache_;
};

}  // namespace reeb::ooc
