// What the sweep of one chunk numbers, each kind with a type of its own.
#pragma once

#include <concepts>
#include <cstdint>

#include "libreeb/base/ids.h"

namespace reeb {

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

}  // namespace reeb
