// Where noise removal can change a graph, told from its short arcs alone
// (docs/SEMANTICS.md, Noise removal).
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// Whether an arc between these values can be, or become part of, an arc of less persistence than
// `threshold`. Joining arcs never makes one shorter, so no other can ever be removed.
inline bool is_short(double lo, double hi, double threshold) { return hi - lo < threshold; }

// `short_arcs` are all short arcs of a graph and their ends, `degrees` those of these nodes in the
// whole graph. True for the nodes of `short_arcs` that removing leaves, until nothing changes, can
// look at: denoise_part() of them and their arcs does what denoise() does to the whole graph. Some
// more may be true, never less.
//
// A leaf's arc that is removed is a chain of short arcs, the inner nodes of which have disappeared.
// Such a node had lost all but one of its arcs on each side as leaves. So an arc is taken to be
// *loose*, from its nearer end on, if it ends in an extremum, or in a node that may disappear when
// its loose arcs are gone and has one in the same direction. What looks for another path from a loose
// arc, or for the place of what it held, goes no farther than the leaf.
//
// TIME:   O(nodes + arcs of short_arcs).
// MEMORY: 8 bytes an arc and 25 a node, and what a stack of nodes takes.
std::vector<bool> noise_scope(const ReebGraph& short_arcs, const Degrees& degrees);

}  // namespace reeb
