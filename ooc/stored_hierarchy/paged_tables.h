// The tables of a Canceller in pages, for graphs that memory does not hold.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/stored_hierarchy/paged_rows.h"

namespace reeb::ooc {

// An entry for each id. Reading copies it; a reference is valid until the next access to a table of ids of this kind.
template <class Id, class T>
class PagedIdTable {
 public:
  PagedIdTable(std::shared_ptr<PagedRows> rows, std::uint32_t size, const T& fill)
      : rows_(std::move(rows)), column_(rows_->add_column(fill)), size_(size) {}

  // The fill value if the row of the id was dropped.
  T operator[](Id id) const { return rows_->get(column_, id.value()); }
  T& operator[](Id id) { return rows_->change(column_, id.value()); }
  Id end_id() const { return Id(size_); }
  std::uint32_t size() const { return size_; }
  // Sets all entries. REQUIRES: this is the size.
  void assign(std::uint32_t /*size*/, const T& value) { rows_->set_all(column_, value); }

 private:
  std::shared_ptr<PagedRows> rows_;
  PagedRows::Column<T> column_;
  std::uint32_t size_;
};

// Tables of what belongs to nodes and to arcs. They are columns of the same rows, of nodes and of arcs, which share
// this memory in proportion to their sizes (libreeb/graph/tables_in_memory.h). A copy makes tables of the same rows.
class PagedTables {
 public:
  // How many rows there are, and the bytes of all their entries.
  struct Size {
    std::uint32_t rows = 0;
    std::size_t row_bytes = 0;
    std::uint64_t bytes() const { return std::uint64_t{rows} * row_bytes; }
  };

  // REQUIRES: `temp` and `budget` outlive the tables.
  PagedTables(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t memory_bytes, const Size& nodes,
              const Size& arcs)
      : nodes_(std::make_shared<PagedRows>(temp, budget, nodes.rows, nodes.row_bytes,
                                           share(memory_bytes, nodes.bytes(), arcs.bytes()))),
        arcs_(std::make_shared<PagedRows>(temp, budget, arcs.rows, arcs.row_bytes,
                                          share(memory_bytes, arcs.bytes(), nodes.bytes()))) {}

  template <class Id, class T>
  using Table = PagedIdTable<Id, T>;

  template <class Id, class T>
  Table<Id, T> table(std::uint32_t size, const T& fill) const {
    return {std::is_same_v<Id, NodeId> ? nodes_ : arcs_, size, fill};
  }
  template <class Entries, class Id>
  void prefetch(const Entries& /*entries*/, Id /*id*/) const {}

  // From now on the tables share this much memory, if it is more.
  void allow(std::uint64_t memory_bytes) {
    nodes_->pages().allow(share(memory_bytes, nodes_->bytes(), arcs_->bytes()));
    arcs_->pages().allow(share(memory_bytes, arcs_->bytes(), nodes_->bytes()));
  }

  PagedRows& nodes() const { return *nodes_; }
  PagedRows& arcs() const { return *arcs_; }

  // How often a page was read again; the memory of all pages; bytes written to their files.
  std::uint64_t refetches() const { return nodes_->pages().refetches() + arcs_->pages().refetches(); }
  std::uint64_t resident_bytes() const { return nodes_->pages().resident_bytes() + arcs_->pages().resident_bytes(); }
  std::uint64_t spilled_bytes() const { return nodes_->pages().spilled_bytes() + arcs_->pages().spilled_bytes(); }

 private:
  static std::uint64_t share(std::uint64_t memory, std::uint64_t own, std::uint64_t other) {
    const double part = static_cast<double>(own) / (static_cast<double>(own) + static_cast<double>(other) + 1);
    return static_cast<std::uint64_t>(part * static_cast<double>(memory));
  }

  std::shared_ptr<PagedRows> nodes_, arcs_;
};

}  // namespace reeb::ooc
