// What remains of a share of a mesh, or of several: all that the other shares can still change
// (docs/ARCHITECTURE.md, Shares of a mesh).
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/parts/part_set.h"
#include "libreeb/sweep/fragment.h"

namespace reeb {

struct OpenPart {
  // Marked kUsedLater: the vertices that shares outside name. There are no steps.
  Fragment live;
  std::vector<PartSpan> spans;  // by node; of one that no share outside names: without meaning
};

// The vertices that other shares name.
std::uint64_t open_vertices_of(const OpenPart& part);

// THROWS: DamagedState unless this can be glued: no index is out of range, and every path is one.
void check_open_part(const OpenPart& part, std::uint32_t parts);

// Raises the exponent of the buckets of a fragment. REQUIRES: it is not below that of the buckets.
void coarsen_buckets(Fragment& fragment, int exponent);

}  // namespace reeb
