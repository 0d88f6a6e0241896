// A level of the hierarchy together with the history of its arcs (docs/SEMANTICS.md, Cancelling).
#pragma once

#include <cstdint>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/port/arc_log.h"

namespace reeb {

// The graph after this number of cancellations, or after all if there are fewer. Arcs have in `log` their numbers in
// `graph`, and are settled in the order of the result. Arcs and extrema that are cancelled are laid on the paths that
// the rules name; an arc that is taken away without such a path is dropped.
//
// TIME and MEMORY: as build_hierarchy(), without an embedding; in addition, all arcs of a path on which an arc is laid.
// REQUIRES: no node is of degree (1, 1).
ReebGraph cancel_to_version(const ReebGraph& graph, std::uint32_t version, ArcLog& log, const Poll& poll = {});

}  // namespace reeb
