// The memory of the last pass of noise removal.
#pragma once

#include <cstdint>
#include <optional>

#include "libreeb/base/memory_budget.h"
#include "ooc/sorting/record_batch.h"
#include "ooc/stored_graph/arc_ends.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

// Says whether the pass fits the budget. Holds what only saves time, and gives it up for what is needed.
class PassRoom {
 public:
  explicit PassRoom(MemoryBudget& budget)
      : working_(budget.reserve("last pass of noise removal", 0)),
        spare_(budget.reserve("last pass of noise removal", 0)) {}

  bool fits() const { return fits_; }
  std::uint64_t needed_bytes() const { return needed_bytes_; }

  // Whether the pass fits with this much memory. If not, `enough` is recorded as the memory needed.
  bool make(std::uint64_t bytes, std::uint64_t enough) { return make(working_, bytes, enough); }
  bool make(Reservation& memory, std::uint64_t bytes, std::uint64_t enough) {
    if (!fits_) return false;
    bool made = memory.try_resize(bytes);
    if (!made && spare_.bytes() != 0) {
      release_spare();
      made = memory.try_resize(bytes);
    }
    if (!made) refuse(enough);
    return made;
  }
  void refuse(std::uint64_t enough) {
    fits_ = false;
    needed_bytes_ = enough;
  }
  std::uint64_t bytes() const { return working_.bytes(); }
  // Less than before.
  void shrink(std::uint64_t bytes) { working_.try_resize(bytes); }

  // Memory for one of the two below, never both.
  bool try_spare(std::uint64_t bytes) { return spare_.try_resize(bytes); }
  void release_spare() {
    ends.reset();
    kept_arcs.reset();
    spare_.release();
  }
  std::optional<ArcEnds> ends;                      // during the search for short arcs
  std::optional<RecordBatch<StoredArc>> kept_arcs;  // all arcs that noise removal can touch, and some others

 private:
  Reservation working_, spare_;
  bool fits_ = true;
  std::uint64_t needed_bytes_ = 0;
};

}  // namespace reeb::ooc
