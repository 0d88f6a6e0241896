// Where the nodes of a large graph are across: upright branches of a spanning forest, beside each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

// Neighbours of each node: neighbors[offsets[i]] .. [offsets[i + 1]). A neighbour repeats with its arc.
struct Neighbors {
  std::vector<std::size_t> offsets;
  std::vector<std::uint32_t> neighbors;
};
Neighbors neighbors_of(const ReebGraph& graph);

// The place of each node, where branches are at least 1 apart; `height` is from 0 to 1. A branch is a path away from
// the root, on which each node is followed by the child from which one gets highest or lowest. Branches are as near to
// the one they begin at as their outlines allow. Components are beside each other, the largest first; specks
// (io/plot/specks.h) take no room. TIME: O((nodes + arcs) log(nodes)).
std::vector<double> branch_places(const ReebGraph& graph, std::span<const double> height,
                                  std::span<const std::uint32_t> specks);

}  // namespace reeb::io
