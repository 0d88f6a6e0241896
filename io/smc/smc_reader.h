// Reads SMC, versions 1 and 3: triangles as operations on the boundary of the mesh read so far, adaptively coded
// (Isenburg, Lindstrom, Gumhold, Snoeyink: Streaming Compression of Triangle Meshes, 2005). Always pre-order. Messages
// name the triangle; positions are byte offsets.
#pragma once

#include <optional>

#include "io/events/stream_event.h"
#include "io/smc/range_coder.h"
#include "io/smc/smc_positions.h"
#include "io/smc/smc_state.h"
#include "io/text/cursor.h"

namespace reeb::io {

class SmcEventReader : public EventReader {
 public:
  // REQUIRES: the cursor is at the version byte, 1 or 3. THROWS: as next().
  explicit SmcEventReader(Cursor cursor);

  std::uint64_t bytes_read() const override { return cursor_.bytes_read(); }
  std::uint64_t memory_bytes() const override { return EventReader::memory_bytes() + state_.memory_bytes(); }

 private:
  void fill() override;
  // False at the end of the stream.
  bool read_triangle();
  bool read_start(SmcState::Triangle& triangle);
  void read_edge(SmcState::Triangle& triangle, SmcOperation operation);
  SmcOperation read_pair(SmcState::Triangle& triangle);

  std::uint32_t read_active();
  std::uint32_t read_cached(std::size_t entry) const;
  std::uint32_t read_edge_at(std::uint32_t slot, bool incoming);
  void read_new_vertex(SmcState::Triangle& triangle, std::size_t corner, const PredictionInput& from);
  void deliver(const SmcState::Triangle& triangle, SmcOperation operation);
  void finish();
  template <class Action>
  void guarded(Action action);

  unsigned version_;
  Cursor cursor_;
  std::optional<RangeDecoder> decoder_;
  std::optional<PositionCoder> positions_;
  SmcModels models_;
  SmcState state_;
  std::uint32_t vertices_ = 0;
  std::uint64_t triangles_ = 0;
  std::uint32_t new_vertices_ = 0;  // of the triangle being read
  bool done_ = false;
};

}  // namespace reeb::io
