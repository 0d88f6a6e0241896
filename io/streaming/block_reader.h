// Reads SMB (triangles) and SVB (tetrahedra): binary blocks of 32 elements.
//
// A block is a 32-bit descriptor, then up to 32 elements of 12 (SMB) or 16 (SVB) bytes. The bits of the descriptor,
// lowest first, are 1 for a vertex and 0 for a cell. Positions of faults are byte offsets.
#pragma once

#include "io/events/index_rules.h"
#include "io/events/stream_event.h"
#include "io/text/cursor.h"

namespace reeb::io {

// kWords: 32-bit words of an element, which is also the number of corners of a cell.
template <std::size_t kWords>
class BlockEventReader : public EventReader {
 public:
  explicit BlockEventReader(Cursor cursor);

  std::uint64_t bytes_read() const override { return cursor_.bytes_read(); }
  std::uint64_t memory_bytes() const override { return EventReader::memory_bytes() + rules_.memory_bytes(); }

 private:
  static constexpr std::size_t kElementBytes = 4 * kWords;

  void fill() override;
  void read_vertex(const char* element, std::uint64_t position);
  void read_cell(const char* element, std::uint64_t position);
  void finish();

  Cursor cursor_;
  bool swap_ = false;
  IndexRules rules_;
  std::uint64_t cells_ = 0;
  bool done_ = false;
};

using SmbEventReader = BlockEventReader<3>;
using SvbEventReader = BlockEventReader<4>;

}  // namespace reeb::io
