// A part of the mesh with vertex numbers of its own: the unit that one sweep works on.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

// Ids of the sweep of a chunk.
//
// A vertex of a chunk: its index in the chunk's arrays.
using LocalVertex = Id<struct LocalVertexTag, std::uint32_t>;
// A vertex of a chunk: its rank in the total order of the chunk's vertices.
using VertexRank = Id<struct VertexRankTag, std::uint32_t>;
// A node of the graph that a sweep records, in the order of the sweep; and an arc, in the order of creation.
using SweepNode = Id<struct SweepNodeTag, std::uint32_t>;
using SweepArc = Id<struct SweepArcTag, std::uint32_t>;
// An open node or arc of a fragment: its index in the fragment's arrays.
using FragmentNode = Id<struct FragmentNodeTag, std::uint32_t>;
using FragmentArc = Id<struct FragmentArcTag, std::uint32_t>;

static_assert(!std::equality_comparable_with<VertexId, LocalVertex>);
static_assert(!std::equality_comparable_with<LocalVertex, VertexRank>);
static_assert(!std::equality_comparable_with<SweepNode, SweepArc>);
static_assert(!std::equality_comparable_with<SweepNode, FragmentNode>);
static_assert(!std::equality_comparable_with<SweepArc, FragmentArc>);

// Whether other chunks might have simplices of a vertex: a set of bits.
// A bit that is set without need costs memory and time, never correctness.
enum VertexUse : std::uint8_t {
  kUsedHereOnly = 0,
  kUsedEarlier = 1,
  kUsedLater = 2,
  // A regular vertex that other chunks have, too, each as if it were the only one. It is in no bucket of this chunk,
  // since one of the others has it there. No other bit may be set.
  kCountedElsewhere = 128,
};

// Faces of a box of grid vertices, as a set of bits: 2 * k for the low end of axis k, 2 * k + 1 for its high end.
using BoxFaces = std::uint8_t;
constexpr BoxFaces low_face(std::size_t axis) { return static_cast<BoxFaces>(1u << (2 * axis)); }
constexpr BoxFaces high_face(std::size_t axis) { return static_cast<BoxFaces>(2u << (2 * axis)); }
inline constexpr BoxFaces kHighFaces = high_face(0) | high_face(1) | high_face(2);

// Vertices along each axis of a box of grid vertices; vertex (i, j, k) has the number i + box[0] * (j + box[1] * k).
using BoxSize = std::array<std::uint32_t, 3>;

// Local vertex i is ids[i], uses[i]; each mesh vertex occurs once. Vertices without a simplex are isolated points of
// the chunk. Of a box, uses[i] is the set of shared faces that the vertex is on. Function values are not part of it:
// they are in one array per function, finite, without -0.0.
struct Chunk {
  std::vector<VertexId> ids;
  std::vector<std::uint8_t> uses;
  std::vector<Point> positions;        // one per vertex, or empty when not tracked
  std::vector<std::uint32_t> corners;  // three local vertices per triangle, repeats legal
  // Set instead of corners if the chunk is a box of a grid with all of its simplices (libreeb/grid/box_sweep.h).
  BoxSize box{};
  BoxFaces shared_faces = 0;  // that other boxes have, too

  std::size_t vertex_count() const { return ids.size(); }
  std::size_t triangle_count() const { return corners.size() / 3; }
  Point position(LocalVertex v) const { return positions.empty() ? Point{} : positions[v.value()]; }
  void clear() {
    ids.clear();
    uses.clear();
    positions.clear();
    corners.clear();
    box = {};
    shared_faces = 0;
  }
};

// Empties a buffer that each chunk fills anew, and makes room for n elements. Where that takes new memory, it takes an
// eighth more, but no more than any chunk needs (`most`). So the next chunk that is a little larger needs none. First
// use of new memory is slow: each page is a fault. REQUIRES: n <= most.
template <class Buffer>
void clear_with_room(Buffer& buffer, std::size_t n, std::size_t most = ~std::size_t{0}) {
  buffer.clear();
  if (buffer.capacity() < n) buffer.reserve(n / 8 < most - n ? n + n / 8 : most);
}

// The same, and fills it with n times this value.
template <class Buffer, class T>
void fill_with_room(Buffer& buffer, std::size_t n, const T& value) {
  clear_with_room(buffer, n);
  buffer.assign(n, value);
}

}  // namespace reeb
