// Reeb graphs as text files that other programs read (docs/CLI.md, `reeb extract FILE`).
#pragma once

#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/arc_measures.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

// What is exported. Refers to data of the caller, which must outlive it.
struct GraphView {
  const ReebGraph& graph;
  std::string_view function;
  double threshold = 0;
  ArcBucketsView buckets;  // of graph's arcs, or empty
  int bucket_exponent = 0;
  std::span<const ArcMeasures> measures = {};  // of graph's arcs, or empty; json, vtp and vtu have them
  bool has_spreads = false;                    // the buckets have spreads and rims
  bool on_surface = false;                     // lines pass through rims; needs them
};

enum class GraphFormat { kRg, kJson, kCsv, kDot, kGraphml, kVtp, kVtu, kPly, kObj, kSwc, kGltf };

// Whether the format draws arcs as lines in space.
bool has_lines(GraphFormat format);

// The format with this name ("rg", "json", ...), if there is one.
std::optional<GraphFormat> graph_format(std::string_view name);
// The names, for messages: "rg json csv dot ...".
std::string graph_format_names();

// Numbers restore every double. Formats with lines in space draw an arc along its buckets, if it has any, and put nodes
// without known positions at (0, 0, value).
//
// TIME:    O((nodes + arcs) log(nodes) + buckets), and that of `out`.
// MEMORY:  of the whole graph, what find_features() takes; items are written one by one.
// THREADS: any number of calls at the same time, each with a stream of its own.
//
//   rg       the project's own: sorted lines `n VERTEX DOWN UP VALUE` and `a LO HI`
//   json     schema reeb.graph.v1
//   csv      two tables with an empty line between them: nodes, arcs
//   dot, graphml      a graph; nodes are named by their vertices
//   vtp, vtu          VTK XML, lines and data with TTK's names
//   ply, obj          vertices and edges or lines
//   swc      samples of trees (swc_samples.h)
//   gltf     lines, and nodes as points; one file
void write_graph(GraphFormat format, const GraphView& view, std::ostream& out);

// The two tables of csv, each to a stream of its own.
void write_csv_tables(const GraphView& view, std::ostream& nodes, std::ostream& arcs);

}  // namespace reeb::io
