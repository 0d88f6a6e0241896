// Where the nodes and arcs of a laid-out graph are: upwards by the value of the function, sideways as fits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/drawing/svg_text.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

// x and y go from 0 to 1; y is the share of the range of values.
struct GraphLayout {
  std::vector<PicturePoint> nodes;
  // Of each arc, from its lower to its upper node: the ends and control points of one or more cubic Bezier curves.
  std::vector<std::vector<PicturePoint>> arcs;

  enum class Part : std::uint8_t { kMain, kSpeck, kLeftOut };  // specks: components of one node or one arc
  std::vector<Part> parts;                                     // of each node
  double speck_distance = 0;                                   // across
  std::size_t left_out = 0;                                    // components for which there is no room
};

// The share of the range of the graph's values that lies below each node; 0.5 if all are equal.
std::vector<double> heights(const ReebGraph& graph);

// The curve of an arc that leaves and reaches its nodes upright, `bend` beside the straight line.
std::vector<PicturePoint> upright_curve(PicturePoint lo, PicturePoint hi, double bend);

// For graphs of any size: the paths of a spanning forest that rise or fall most are upright, and branches are beside
// them, as near as there is room. Components of one node or one arc are to the right.
// TIME: O((nodes + arcs) log(nodes)).
GraphLayout layered_layout(const ReebGraph& graph);

}  // namespace reeb::io
