// How pictures mark nodes: minima, maxima, forks and isolated nodes differ in shape and colour.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/drawing/svg_text.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

enum class NodeKind : std::uint8_t { kIsolated, kMinimum, kMaximum, kFork };

std::vector<NodeKind> node_kinds(const ReebGraph& graph);

Rgb node_color(NodeKind kind);

// An element of class "node" around `at`, without a stroke of its own. Minima point down, maxima up.
void append_node(std::string& svg, PicturePoint at, NodeKind kind, double radius, std::string_view name = "node");

// The kinds that occur, each with its number, in a row that begins at `at`. Returns where the row ends.
double append_legend(std::string& svg, PicturePoint at, std::span<const NodeKind> kinds);

}  // namespace reeb::io
