// A laid-out graph as a picture: upwards by value, with an axis.
#pragma once

#include <string>

#include "io/drawing/svg_text.h"
#include "io/plot/graph_layout.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

// Up to this many arcs are lines (class "arc") and their nodes marks (class "node"); more are drawn as an image, which
// keeps the file small.
inline constexpr std::size_t kMostArcsAsLines = 8000;

// REQUIRES: a node.
std::string graph_picture(const ReebGraph& graph, const GraphLayout& layout, const std::string& function,
                          const Heading& heading);

}  // namespace reeb::io
