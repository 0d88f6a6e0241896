// Components of one node or one arc, of which there are often many: in a band beside the rest of a laid-out graph.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/plot/graph_layout.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

inline constexpr std::uint32_t kNoSpeck = ~std::uint32_t{0};

// For each node of a component of one node or one arc the lower node of the component, for others kNoSpeck.
std::vector<std::uint32_t> specks_of(const ReebGraph& graph);

// Puts these components to the right of all that the layout has, which moves to the left; in columns, as far apart as
// at most a quarter of the width allows. Those that find no place, the shortest, are left out.
// REQUIRES: the layout has all nodes and arcs, these ones anywhere. TIME: O(nodes log(nodes) + arcs).
void place_specks(const ReebGraph& graph, std::span<const std::uint32_t> specks, GraphLayout& layout);

}  // namespace reeb::io
