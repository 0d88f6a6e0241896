// A row of entries for each of many ids, in pages. Rows that are no longer needed can be dropped.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/containers/kept_ids.h"
#include "ooc/tables/page_cache.h"

namespace reeb::ooc {

// All entries of an id are in one page, so whoever needs several of them waits for one page. Within a page, entries are
// stored column by column. Rows are in the order of ids. When rows are dropped, the others move together into fewer
// pages.
//
// THROWS: Error{kResource} if the disk is full, or the budget lacks the smallest working set.
// MEMORY: as PageCache and KeptIds.   THREADS: one at a time.
class PagedRows {
 public:
  // It needs at least this much memory.
  static constexpr std::uint64_t kLeastBytes = PageCache::kRequiredFrames * PageCache::kPageBytes;

  static constexpr std::size_t kMostRowBytes = 64;

  // One entry of each row.
  template <class T>
  struct Column {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 16);
    std::size_t begin;  // of the entries in a page
    T fill;             // value of an entry that was never set, and of an id without a row
  };

  // `row_bytes` is that of all columns together, at most kMostRowBytes.
  PagedRows(const io::TempDir& temp, MemoryBudget& budget, std::uint32_t rows, std::size_t row_bytes,
            std::uint64_t allowance_bytes)
      : page_rows_(static_cast<std::uint32_t>(PageCache::kPageBytes / row_bytes)),
        fill_(PageCache::kPageBytes),
        ids_charge_(budget.reserve("hierarchy", KeptIds::bytes_for(rows))),
        ids_(rows),
        cache_("hierarchy", temp, budget, allowance_bytes, fill_) {}

  // REQUIRES: no entry was set yet, or the bytes of the fill value are 0.
  template <class T>
  Column<T> add_column(const T& fill) {
    const std::size_t begin = page_rows_ * used_row_bytes_;
    if (begin + page_rows_ * sizeof(T) > PageCache::kPageBytes || begin % alignof(T) != 0 ||
        used_row_bytes_ + sizeof(T) > kMostRowBytes)
      throw std::logic_error("PagedRows: a page has no room for the column");
    used_row_bytes_ += sizeof(T);
    column_bytes_.push_back(sizeof(T));
    const auto bytes = std::as_bytes(std::span(&fill, 1));
    if (std::ranges::any_of(bytes, [](std::byte byte) { return byte != std::byte{0}; })) {
      for (std::size_t row = 0; row < page_rows_; ++row)
        std::ranges::copy(bytes, fill_.begin() + static_cast<std::ptrdiff_t>(begin + row * sizeof(T)));
      cache_.set_fill(fill_);
    }
    return {begin, fill};
  }

  template <class T>
  T get(const Column<T>& column, std::uint32_t id) {
    if (!ids_.has(id)) return column.fill;
    return entry(column, ids_.rank(id), false);
  }
  // To be changed in place; valid until the next access to any column. REQUIRES: the id has a row.
  template <class T>
  T& change(const Column<T>& column, std::uint32_t id) {
    if (!ids_.has(id)) throw std::logic_error("PagedRows: a row that was dropped");
    return entry(column, ids_.rank(id), true);
  }
  // Sets the entries of all rows.
  template <class T>
  void set_all(const Column<T>& column, const T& value) {
    for (std::uint32_t row = 0; row < ids_.count(); ++row) entry(column, row, true) = value;
  }

  // Drops the rows of the ids for which stays(id) is false. It may read this id's entries.
  template <class Stays>
  void keep_if(const Stays& stays) {
    std::uint32_t to = 0;
    ids_.keep_if([&](std::uint32_t id) {
      if (!stays(id)) return false;
      move_row(ids_.rank(id), to++);
      return true;
    });
    cache_.drop_from((std::size_t{to} + page_rows_ - 1) / page_rows_);
  }

  // Whether the pages in memory are enough for all rows.
  bool fits_in_memory() const { return bytes() <= cache_.resident_bytes(); }
  std::uint32_t count() const { return ids_.count(); }
  std::uint64_t bytes() const { return (std::uint64_t{ids_.count()} / page_rows_ + 1) * PageCache::kPageBytes; }
  const PageCache& pages() const { return cache_; }
  PageCache& pages() { return cache_; }

 private:
  template <class T>
  T& entry(const Column<T>& column, std::uint32_t row, bool writing) {
    const std::uint32_t page = row / page_rows_;
    return reinterpret_cast<T*>(cache_.page(page, writing) + column.begin)[row - page * page_rows_];
  }

  void move_row(std::uint32_t from, std::uint32_t to) {
    if (from == to) return;
    std::array<std::byte, kMostRowBytes> row;
    const std::byte* source = cache_.page(from / page_rows_, false);
    for_each_column([&](std::size_t begin, std::size_t bytes) {
      std::memcpy(&row[begin], source + page_rows_ * begin + from % page_rows_ * bytes, bytes);
    });
    std::byte* target = cache_.page(to / page_rows_, true);
    for_each_column([&](std::size_t begin, std::size_t bytes) {
      std::memcpy(target + page_rows_ * begin + to % page_rows_ * bytes, &row[begin], bytes);
    });
  }
  // Calls visit(bytes of the columns before it, its own).
  template <class Visit>
  void for_each_column(const Visit& visit) const {
    std::size_t begin = 0;
    for (const std::size_t bytes : column_bytes_) {
      visit(begin, bytes);
      begin += bytes;
    }
  }

  std::uint32_t page_rows_;
  std::vector<std::size_t> column_bytes_;  // of an entry, by column
  std::size_t used_row_bytes_ = 0;         // of these columns
  std::vector<std::byte> fill_;            // of a page
  Reservation ids_charge_;
  KeptIds ids_;
  PageCache cache_;
};

}  // namespace reeb::ooc
