// Where noise removal can change a graph, determined from its short arcs alone (docs/SEMANTICS.md, Noise removal).
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// Whether an arc between these values rises less than `threshold`. Joining arcs never makes an arc shorter, so only
// short arcs can be removed or become part of an arc that is removed.
inline bool is_short(double lo, double hi, double threshold) { return hi - lo < threshold; }

// `short_arcs` are all short arcs of a graph and their ends, `degrees` those of these nodes in the whole graph. Returns
// true for the nodes of `short_arcs` that noise removal can touch: denoise_part() of these nodes and their arcs changes
// the graph as denoise() of the whole graph does. It might be true for some more nodes, never for fewer.
//
// The arc of a removed leaf is a chain of short arcs whose inner nodes were contracted. Each of these nodes had lost
// all but one of its arcs on each side, as arcs of leaves. So an arc counts as *loose* in a direction if its end in
// that direction is an extremum, or a node with a loose arc in the same direction that can be contracted when its loose
// arcs are gone. Searches for another path than a loose arc, and for arcs to which its vertices are moved, go no
// farther than the leaf.
//
// TIME:   O(nodes + arcs of short_arcs).
// MEMORY: 8 bytes per arc and 25 per node, and a stack of nodes.
std::vector<bool> noise_scope(const ReebGraph& short_arcs, const Degrees& degrees);

}  // namespace reeb
