// Noise removal on a graph in memory, or on a part of one: the exact last pass
// (docs/SEMANTICS.md, Noise removal).
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/packed_lists.h"

namespace reeb {

struct Denoised {
  ReebGraph graph;
  // The pairs that are gone, Ord0 and Rel1 only, by the nodes of the graph that was given, in the
  // order of cancelling. All others are as before.
  std::vector<PersistencePair> removed;
  // Of each arc, the number in the graph that was given of its lowest part.
  std::vector<ArcId> former;
};

// Repeats, until nothing changes: remove a leaf (an extremum with one arc) of persistence <
// threshold whose saddle has another monotone path, in the leaf's direction, that reaches beyond
// the leaf in the total order; then (1, 1) nodes disappear. The result does not depend on any order
// of steps.
//
// TIME:   O(m log m).
// MEMORY: besides the graph, which becomes the result, 32 bytes an arc and 20 a node; 36 a removed
//         pair (12 of them the result).
// REQUIRES: no node is of degree (1, 1).
Denoised denoise(ReebGraph graph, double threshold);

// The same with an embedding: `buckets`, of the graph's arcs, becomes that of the result's. What a
// removed leaf held, and the leaf itself, are laid on a path that proves that it may go, taking at
// each choice the arc with the nearest end of those from which the path reaches beyond the leaf. A
// node that disappears enters a bucket. So vertices in buckets + nodes stay the same. With empty
// `buckets` there is no embedding.
//
// TIME:   besides, the buckets of the arcs that a removal changes, and one copy of all.
// MEMORY: besides, ArcBucketLists: 8 bytes an arc, 6 a list and its packed buckets, with holes half as much
//         again; at the end, when the rest is free again, 8 an arc and 40 a bucket for the result.
// REQUIRES: all buckets are of this exponent, and none is empty.
Denoised denoise(ReebGraph graph, double threshold, ArcBuckets& buckets, int exponent);

// The same in a part of a graph: all arcs of the nodes that are `whole`, in the order of the graph.
// Other nodes only say where those arcs end, and stay. With the nodes of noise_scope() whole, the
// arcs and buckets of the result, in the place of the part's, make of the graph what denoise() does.
Denoised denoise_part(ReebGraph part, const std::vector<bool>& whole, double threshold, PackedLists& buckets,
                      int exponent);

}  // namespace reeb
