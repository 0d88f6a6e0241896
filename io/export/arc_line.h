// The line that an arc is drawn as, from the buckets of its embedding (DESIGN.md 5).
//
// A bucket's mean is the centre of a slab of the surface as far as vertices sample that slab evenly.
// On coarse meshes, and where a cancelled feature enters or leaves the arc, means of neighbours lie
// to either side of the line that one sees; and from a node on the surface to the first centre is a
// jump. So each point of the line is a mean over a window of buckets, in which
//  - a bucket counts less the farther it is, in buckets;
//  - it counts by the root of its vertices: one vertex does not bend the line, a feature laid onto
//    the arc does not swamp it;
//  - beyond the end of the arc there is its node, again and again, so the line bends into its nodes,
//    which stay on their vertices.
// Weights are not negative: a line stays in the convex hull of its nodes and means.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb::io {

// Buckets to either side in a window; not more than a third of the arc's, so that a short arc keeps
// its shape.
inline constexpr std::size_t kLineReach = 7;

// Replaces `line` by one point for each non-empty bucket, from below: what lies between `lo` and `hi`.
// O(buckets).
void draw_arc(const std::array<double, 3>& lo, std::span<const Bucket> buckets, const std::array<double, 3>& hi,
              std::vector<std::array<double, 3>>& line);

}  // namespace reeb::io
