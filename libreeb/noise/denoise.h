// Noise removal on a graph in memory, or on a part of one: the exact last pass
// (docs/SEMANTICS.md, Noise removal).
#pragma once

#include <vector>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/packed_lists.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/port/arc_log.h"

namespace reeb {

struct Denoised {
  ReebGraph graph;
  // The removed pairs, all Ord0 or Rel1, in the order of cancelling. Their nodes are numbered as in the given graph.
  // All other pairs are as before.
  std::vector<PersistencePair> removed;
  // For each arc, the number that its lowest part had in the given graph.
  std::vector<ArcId> former;
};

// Repeats, until nothing changes: remove a leaf (an extremum with one arc) of persistence < threshold whose saddle has
// another monotone path, in the leaf's direction, that reaches beyond the leaf in the total order; then contract the
// saddle if it is a (1, 1) node. The result does not depend on the order of the steps.
//
// TIME:   O(m log m).
// MEMORY: in addition to the graph, which becomes the result, 32 bytes per arc and 28 per node; 36 per removed pair (12
//         of them the result).
// REQUIRES: no node is of degree (1, 1).
Denoised denoise(ReebGraph graph, double threshold);

// The same, with the history of the arcs: arcs have their numbers in the given graph, and are settled in the order of
// the result. A removed leaf and its arc are laid on the path that is described below.
Denoised denoise(ReebGraph graph, double threshold, ArcLog& log);

// The same with an embedding: `buckets`, of the graph's arcs, become those of the result's arcs. The vertices of a
// removed leaf's arc, and the leaf, are moved to another path from its saddle that reaches beyond the leaf: at each
// choice it takes, of the arcs from which it can still reach beyond, the one with the nearest end. A contracted node
// enters a bucket. So vertices in buckets + nodes stay the same. With empty `buckets` there is no embedding.
//
// TIME:   in addition, the buckets of the arcs that a removal changes, and one copy of all.
// MEMORY: in addition, ArcBucketLists: 8 bytes per arc, 6 per list and its packed buckets, with holes half as much
//         again; at the end, when the rest is free again, 8 per arc and 40 per bucket for the result.
// REQUIRES: all buckets are of this exponent, and none is empty.
Denoised denoise(ReebGraph graph, double threshold, ArcBuckets& buckets, int exponent);

// The same in a part of a graph, which has all arcs of the nodes that are `whole`, in the order of the graph. The other
// nodes are only the ends of these arcs, and stay. If the nodes of noise_scope() are whole, replacing the part by the
// result, with its buckets, changes the graph as denoise() does.
Denoised denoise_part(ReebGraph part, const std::vector<bool>& whole, double threshold, PackedLists& buckets,
                      int exponent);

}  // namespace reeb
