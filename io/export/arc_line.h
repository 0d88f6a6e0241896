// The line that is drawn for an arc, made from the buckets of its embedding (docs/SEMANTICS.md, Buckets).
//
// The mean of a bucket is the centre of a slab of the surface, if vertices sample that slab evenly. On coarse meshes,
// and where a cancelled pair enters or leaves the arc, the means of neighbouring buckets are on alternate sides of the
// line that one would draw. The first centre is also far from the node, which is on the surface. So each point of the
// line is a mean over a window of buckets, in which
//  - the weight of a bucket falls with its distance, counted in buckets;
//  - the weight is proportional to the square root of its vertex count: a single vertex does not bend the line, and
//    the vertices of a cancelled pair that were moved to the arc do not dominate it;
//  - beyond each end of the arc its node is repeated, so the line bends into its nodes, which stay on their vertices.
// No weight is negative, so a line stays in the convex hull of its nodes and means.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb::io {

// Buckets on either side in a window; at most a third of the arc's, so that a short arc keeps its shape.
inline constexpr std::size_t kLineReach = 7;

// Replaces `line` by one point for each non-empty bucket, from below: the points between `lo` and `hi`.
// TIME: O(buckets).
void draw_arc(const std::array<double, 3>& lo, std::span<const Bucket> buckets, const std::array<double, 3>& hi,
              std::vector<std::array<double, 3>>& line);

// Replaces `radii` by the radius of the contour for each non-empty bucket, from below: the root of the mean squared
// distance of its vertices from its centre. For a circle with even vertices that is its radius.
//
// A bucket may have vertices of a part of the contour only, where rows of them cross it at an angle. So two buckets on
// either side are used with it, more if there are few vertices, and the centre is on the straight line that fits their
// means best. The vertices of these buckets also spread along the arc, since the centre moves and the radius grows or
// falls while the value passes them. What that adds is taken off.
// REQUIRES: buckets with spreads. TIME: O(buckets).
void find_radii(std::span<const Bucket> buckets, std::vector<double>& radii);

// The same at the points of the line. Near nodes, these are moved along the arc; the radius is that of the place to
// which they are moved. `lo` and `hi` are the values of the nodes divided by the width of a bucket.
void find_line_radii(double lo, std::span<const Bucket> buckets, double hi, std::vector<double>& radii);

}  // namespace reeb::io
