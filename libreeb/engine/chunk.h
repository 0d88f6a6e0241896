// A run of the stream's simplices with its own vertex numbers: what one sweep works on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

// Whether simplices of a vertex may lie in other chunks: a set of bits.
// Saying so where it is not the case costs memory and time, never correctness.
enum VertexUse : std::uint8_t {
  kUsedHereOnly = 0,
  kUsedEarlier = 1,
  kUsedLater = 2,
};

// Local vertex i is ids[i], uses[i]; each mesh vertex occurs once. Vertices without a simplex are
// isolated points of the chunk. Function values lie beside a chunk, one array a function: finite,
// no -0.0.
struct Chunk {
  std::vector<VertexId> ids;
  std::vector<std::uint8_t> uses;
  std::vector<Point> positions;        // one a vertex, or empty when not tracked
  std::vector<std::uint32_t> corners;  // three local vertices a triangle, repeats legal

  std::size_t vertex_count() const { return ids.size(); }
  std::size_t triangle_count() const { return corners.size() / 3; }
  void clear() {
    ids.clear();
    uses.clear();
    positions.clear();
    corners.clear();
  }
};

}  // namespace reeb
