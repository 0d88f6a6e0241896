// The tables of a Canceller in pages, for graphs that memory does not hold.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/tables/paged_table.h"

namespace reeb::ooc {

// An entry for each id. Reading copies it; a reference is valid until the next access.
template <class Id, class T>
class PagedIdTable {
 public:
  PagedIdTable(std::unique_ptr<PagedTable<T>> table, std::uint32_t size) : table_(std::move(table)), size_(size) {}

  T operator[](Id id) const { return table_->get(id.value()); }
  T& operator[](Id id) { return table_->change(id.value()); }
  Id end_id() const { return Id(size_); }

 private:
  std::unique_ptr<PagedTable<T>> table_;
  std::uint32_t size_;
};

// Tables that share this much memory, each in proportion to its size (libreeb/graph/tables_in_memory.h). A copy makes
// tables with the same memory.
class PagedTables {
 public:
  // `all_bytes` is the size of all tables together. REQUIRES: `temp` and `budget` outlive the tables.
  PagedTables(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t memory_bytes, std::uint64_t all_bytes)
      : temp_(&temp),
        budget_(&budget),
        all_bytes_(static_cast<double>(std::max<std::uint64_t>(1, all_bytes))),
        share_(static_cast<double>(memory_bytes) / all_bytes_),
        made_(std::make_shared<std::vector<Made>>()) {}

  template <class Id, class T>
  using Table = PagedIdTable<Id, T>;

  template <class Id, class T>
  Table<Id, T> table(std::uint32_t size, const T& fill) const {
    // Pages have room for a power of two.
    const std::uint64_t bytes = (std::uint64_t{size} / PagedTable<T>::kPageEntries + 1) * PageCache::kPageBytes;
    const auto allowance = static_cast<std::uint64_t>(share_ * static_cast<double>(bytes));
    auto made = std::make_unique<PagedTable<T>>("hierarchy", *temp_, *budget_, allowance, fill);
    made_->push_back({&made->pages(), bytes});
    return {std::move(made), size};
  }
  template <class Entries, class Id>
  void prefetch(const Entries& /*entries*/, Id /*id*/) const {}

  // From now on the tables share this much memory, if it is more. REQUIRES, as the next three: all tables exist.
  void allow(std::uint64_t memory_bytes) {
    share_ = static_cast<double>(memory_bytes) / all_bytes_;
    for (const Made& table : *made_)
      table.pages->allow(static_cast<std::uint64_t>(share_ * static_cast<double>(table.bytes)));
  }

  // How often a page of any table was read again; the memory of all pages; bytes written to their files.
  std::uint64_t refetches() const { return sum(&PageCache::refetches); }
  std::uint64_t resident_bytes() const { return sum(&PageCache::resident_bytes); }
  std::uint64_t spilled_bytes() const { return sum(&PageCache::spilled_bytes); }

 private:
  struct Made {
    PageCache* pages;
    std::uint64_t bytes;  // of the whole table
  };

  std::uint64_t sum(std::uint64_t (PageCache::*figure)() const) const {
    std::uint64_t sum = 0;
    for (const Made& table : *made_) sum += (table.pages->*figure)();
    return sum;
  }

  const io::TempDir* temp_;
  MemoryBudget* budget_;
  double all_bytes_, share_;
  std::shared_ptr<std::vector<Made>> made_;  // all tables
};

}  // namespace reeb::ooc
