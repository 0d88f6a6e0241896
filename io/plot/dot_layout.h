// Layouts by Graphviz's dot: what it reads and what it writes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/plot/graph_layout.h"

namespace reeb::io {

// The input of dot. Nodes with nearly the same value come into one row.
std::string dot_text(const ReebGraph& graph);
// From what `dot -Tplain` wrote for it; nothing if that is no layout of this graph.
std::optional<GraphLayout> read_dot_layout(const ReebGraph& graph, std::string_view written);

}  // namespace reeb::io
