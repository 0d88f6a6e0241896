// Where the buckets of a chunk have many vertices: for each arc, a slot for each index of a bucket that it can have. So
// the slot of a vertex follows from its arc and its value alone, for four vertices at a time.
#pragma once

#include <cstdint>
#include <span>

#include "libreeb/containers/id_vector.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/sweep/chunk.h"

namespace reeb {

// Indices count from the first one of the chunk here, and are below 2^30.
struct ArcSlots {
  std::uint32_t from;  // index i has the slot `from` + i, modulo 2^32
  std::uint32_t end;   // one more than its last slot
};

// `from` of vertices that are on no arc: their slots are beyond those of all arcs.
inline constexpr std::uint32_t kNoSlot = std::uint32_t{1} << 31;

// Sets result[v] to the slot of vertex v, on arc arcs[v] or none. `slots` has those of each arc, and of no arc.
// REQUIRES: has_avx2(); the indexer has a scale; indices of all values are less than 2^30 from `first_index`, and not
// below it; all spans have the same size but for `slots`.
void find_slots(std::span<const double> values, const IdVector<LocalVertex, SweepArc>& arcs,
                std::span<const ArcSlots> slots, const BucketIndexer& indexer, std::int64_t first_index,
                std::span<std::uint32_t> result);

}  // namespace reeb
