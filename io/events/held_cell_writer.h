// What the writers of SMA, SMB and their volume forms share: the order of the file, and a cell that waits until it is
// known which of its corners are finalized directly after it.
#pragma once

#include <array>
#include <cstdint>
#include <ostream>
#include <span>
#include <utility>

#include "io/events/cell_hold.h"
#include "io/events/format_limits.h"
#include "io/events/stream_writer.h"
#include "io/text/output_buffer.h"

namespace reeb::io {

class HeldCellWriter : public StreamWriter {
 public:
  void write(const StreamEvent& event) final {
    switch (event.kind) {
      case EventKind::kVertex:
        write_held();
        started_ = true;
        write_vertex(event);
        ++vertices_;
        return;
      case EventKind::kTriangle:
      case EventKind::kTetrahedron:
        require_cell_kind(event.kind, header_.volume);
        write_held();
        post_order_ |= !started_;
        started_ = true;
        held_.put(event);
        return;
      case EventKind::kFinalized:
        // In post-order a vertex is final when it arrives.
        if (!post_order_ && !held_.finalize(event.vertex, in_order_)) write_finalized(event.vertex);
        return;
    }
  }

 protected:
  // `in_order`: finalizations keep the order in which they come (CellHold::finalize).
  HeldCellWriter(std::ostream& out, StreamHeader header, bool in_order)
      : out_(out), header_(std::move(header)), in_order_(in_order) {}

  virtual void write_vertex(const StreamEvent& vertex) = 0;
  // `corners` are the numbers to write: from 1; negative and relative to the newest vertex if the corner is final.
  virtual void write_cell(const StreamEvent& cell, std::span<const std::int32_t> corners) = 0;
  // Writes a finalization that the cell before it does not express.
  virtual void write_finalized(std::uint32_t vertex) = 0;

  // Call it before anything else is written, and at the end.
  void write_held() {
    if (!held_.full()) return;
    std::array<std::int32_t, 4> numbers{};
    const std::size_t corners = header_.volume ? 4 : 3;
    for (std::size_t k = 0; k < corners; ++k) {
      const auto corner = static_cast<std::int32_t>(held_.cell().corners[k]);
      numbers[k] = held_.is_final(k) ? corner - static_cast<std::int32_t>(vertices_) : corner + 1;
    }
    write_cell(held_.cell(), std::span(numbers).first(corners));
    ++cells_;
    held_.clear();
  }

  std::uint32_t vertices() const { return vertices_; }
  std::uint32_t cells() const { return cells_; }

  OutputBuffer out_;
  const StreamHeader header_;

 private:
  bool in_order_;
  CellHold held_;
  std::uint32_t vertices_ = 0, cells_ = 0;  // written
  bool started_ = false, post_order_ = false;
};

}  // namespace reeb::io
