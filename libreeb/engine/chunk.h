// A run of the stream's simplices with its own vertex numbers: what one sweep works on.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

// What the sweep of a chunk numbers, each kind with a type of its own.
//
// A vertex of a chunk: its place in the chunk's arrays.
using LocalVertex = Id<struct LocalVertexTag, std::uint32_t>;
// A vertex of a chunk: its rank in the total order of the chunk's vertices.
using VertexRank = Id<struct VertexRankTag, std::uint32_t>;
// A node of the graph that a sweep takes down, in the order of the sweep; and an arc, in the order of creation.
using SweepNode = Id<struct SweepNodeTag, std::uint32_t>;
using SweepArc = Id<struct SweepArcTag, std::uint32_t>;
// An open node or arc of a fragment: its place in the fragment's arrays.
using FragmentNode = Id<struct FragmentNodeTag, std::uint32_t>;
using FragmentArc = Id<struct FragmentArcTag, std::uint32_t>;

static_assert(!std::equality_comparable_with<VertexId, LocalVertex>);
static_assert(!std::equality_comparable_with<LocalVertex, VertexRank>);
static_assert(!std::equality_comparable_with<SweepNode, SweepArc>);
static_assert(!std::equality_comparable_with<SweepNode, FragmentNode>);
static_assert(!std::equality_comparable_with<SweepArc, FragmentArc>);

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
