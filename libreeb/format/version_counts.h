// How many nodes, arcs and buckets each version of a hierarchy has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/format/frame_codec.h"
#include "libreeb/graph/arc_version.h"

namespace reeb {

// Entry e is that of version e, for e = 0..persistence.size(). A node belongs to the versions in which one of its arcs
// lives; a node without arc records is isolated and belongs to all. `bucket_counts` has one entry per arc, or is empty.
// O(arcs log(degree) + versions).
// REQUIRES: arcs are born before they die, and no later than the last version.
std::vector<VersionCounts> count_versions(std::uint32_t node_count, std::span<const ArcVersion> arcs,
                                          std::span<const std::uint32_t> bucket_counts,
                                          std::span<const double> persistence);

}  // namespace reeb
