// Where the entries of the canceller's tables are: here, in memory.
#pragma once

#include <cstdint>

#include "libreeb/base/prefetch.h"
#include "libreeb/containers/id_vector.h"

namespace reeb {

// What the classes of the canceller ask for when they make a table. Another kind of tables has the same functions and
// may hold its entries elsewhere. Then a reference to an entry is valid until the next access to the same table, so no
// reference is kept.
struct TablesInMemory {
  template <class Id, class T>
  using Table = IdVector<Id, T>;

  template <class Id, class T>
  Table<Id, T> table(std::uint32_t size, const T& fill) const {
    Table<Id, T> made;
    made.assign(size, fill);
    return made;
  }
  template <class Entries, class Id>
  void prefetch(const Entries& entries, Id id) const {
    reeb::prefetch(&entries[id]);
  }
};

}  // namespace reeb
