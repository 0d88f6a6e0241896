// Holds one cell back, to learn which of its corners are finalized directly after it.
#pragma once

#include <array>
#include <cstdint>

#include "io/events/stream_event.h"

namespace reeb::io {

class CellHold {
 public:
  bool full() const { return full_; }
  const StreamEvent& cell() const { return cell_; }
  bool is_final(std::size_t corner) const { return final_[corner]; }

  void put(const StreamEvent& cell) {
    cell_ = cell;
    corners_ = cell.kind == EventKind::kTetrahedron ? 4 : 3;
    final_ = {};
    full_ = true;
  }
  void clear() { full_ = false; }

  // Marks the last corner that is `vertex`; false if there is none. With `in_order` also false if a later corner is
  // already marked, since readers deliver the finalizations of a cell in the order of its corners.
  bool finalize(std::uint32_t vertex, bool in_order) {
    for (std::size_t k = full_ ? corners_ : 0; k-- > 0;) {
      if (in_order && final_[k]) return false;
      if (cell_.corners[k] != vertex) continue;
      final_[k] = true;
      return true;
    }
    return false;
  }

 private:
  StreamEvent cell_{};
  std::array<bool, 4> final_{};
  std::size_t corners_ = 0;
  bool full_ = false;
};

}  // namespace reeb::io
