#include "io/export/graph_texts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/export/arc_line.h"
#include "io/export/graph_features.h"
#include "io/text/json_text.h"
#include "io/text/number_text.h"
#include "io/text/xml_text.h"
#include "libreeb/graph/loop_ranges.h"

namespace reeb::io {
namespace {

std::uint64_t vertex_of(const ReebGraph& graph, NodeId node) { return graph.nodes[node.value()].vertex.value(); }

std::uint64_t vertices_of(const GraphView& view, std::size_t arc) {
  std::uint64_t sum = 0;
  if (!view.buckets.empty())
    for (const Bucket& bucket : view.buckets.of(arc)) sum += bucket.count;
  return sum;
}

int number_of(CriticalType type) { return static_cast<int>(type); }

// The ranks of nodes in a drawing, from below: nodes share one if they have one value, and no arc between them. Each
// group of nodes (`group[i]` is that of node i) has ranks of its own.
std::vector<std::uint64_t> drawing_ranks(const ReebGraph& graph, std::span<const std::uint32_t> group) {
  std::vector<std::size_t> after_lower(graph.node_count(), 0);  // 1 + the highest node below
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    std::size_t& after = after_lower[graph.hi[arc].value()];
    after = std::max<std::size_t>(after, graph.lo[arc].value() + 1);
  }
  std::vector<std::uint64_t> ranks(graph.node_count());
  struct LastRank {
    std::size_t first, last;  // nodes
  };
  std::vector<std::optional<LastRank>> of_group(graph.node_count());
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    auto& below = of_group[group[i]];
    if (!below) {
      below = {i, i};
      continue;
    }
    const bool shares = graph.nodes[i].value == graph.nodes[below->last].value && after_lower[i] <= below->first;
    ranks[i] = ranks[below->last] + (shares ? 0 : 1);
    below = {shares ? below->first : i, i};
  }
  return ranks;
}

void write_json_measures(const ArcMeasures& arc, OutputBuffer& out) {
  out << ", \"segment_vertices\": " << arc.vertices << ", \"mean\": ";
  write_json_number(arc.mean, out);
  out << ", \"area\": ";
  write_json_number(arc.area, out);
  out << ", \"shortest_contour\": ";
  write_json_number(arc.shortest_contour, out);
}

}  // namespace

void write_rg(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const Degrees degree = degrees(graph);
  for (std::size_t i = 0; i < graph.node_count(); ++i)
    out << "n " << graph.nodes[i].vertex.value() << ' ' << degree.down[i] << ' ' << degree.up[i] << ' '
        << graph.nodes[i].value << '\n';
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    out << "a " << vertex_of(graph, graph.lo[i]) << ' ' << vertex_of(graph, graph.hi[i]) << '\n';
}

void write_json(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const GraphFeatures features = find_features(graph);
  out << "{\"schema\": \"reeb.graph.v1\", \"function\": ";
  write_json_string(view.function, out);
  out << ", \"threshold\": ";
  write_json_number(view.threshold, out);
  out << ",\n\"nodes\": [";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    out << (i == 0 ? "\n" : ",\n") << "{\"vertex\": " << graph.nodes[i].vertex.value()
        << ", \"value\": " << Shortest{graph.nodes[i].value} << ", \"position\": ";
    if (graph.positions.empty())
      out << "null";
    else
      write_json_point(graph.positions[i], out);
    out << ", \"down\": " << features.degree.down[i] << ", \"up\": " << features.degree.up[i]
        << ", \"type\": " << number_of(features.type(i)) << ", \"component\": " << features.component[i]
        << ", \"persistence\": ";
    write_json_number(features.persistence[i], out);
    out << '}';
  }
  out << "],\n\"arcs\": [";
  std::vector<double> radii;
  for (std::size_t i = 0; i < graph.arc_count(); ++i) {
    out << (i == 0 ? "\n" : ",\n") << "{\"arc\": " << i << ", \"lo\": " << vertex_of(graph, graph.lo[i])
        << ", \"hi\": " << vertex_of(graph, graph.hi[i]) << ", \"vertices\": " << vertices_of(view, i)
        << ", \"loop\": ";
    if (features.loop[i] == kNoLoop)
      out << "null";
    else  // a loop beyond the doubles is one nevertheless
      out << Shortest{std::min(features.loop[i], std::numeric_limits<double>::max())};
    if (!view.measures.empty()) write_json_measures(view.measures[i], out);
    out << ", \"path\": [";
    bool first = true;
    if (!view.buckets.empty())
      for (const Bucket& bucket : view.buckets.of(i)) {
        if (bucket.count == 0) continue;
        out << (std::exchange(first, false) ? "" : ", ") << '[' << Shortest{bucket.mean[0]} << ", "
            << Shortest{bucket.mean[1]} << ", " << Shortest{bucket.mean[2]} << ", " << bucket.count << ']';
      }
    out << ']';
    if (view.has_spreads) {
      out << ", \"radii\": [";
      find_radii(view.buckets.of(i), radii);
      for (std::size_t k = 0; k < radii.size(); ++k) out << (k == 0 ? "" : ", ") << Shortest{radii[k]};
      out << ']';
    }
    out << '}';
  }
  out << "]}\n";
}

void write_node_table(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const GraphFeatures features = find_features(graph);
  out << "node,vertex,value,x,y,z,down,up,type,component,persistence\n";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    out << i << ',' << graph.nodes[i].vertex.value() << ',' << Shortest{graph.nodes[i].value};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out << ',';
      if (!graph.positions.empty()) out << Shortest{graph.positions[i][axis]};
    }
    out << ',' << features.degree.down[i] << ',' << features.degree.up[i] << ',' << number_of(features.type(i)) << ','
        << features.component[i] << ',' << Shortest{features.persistence[i]} << '\n';
  }
}

void write_arc_table(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const std::vector<double> loops = loop_ranges(graph);
  out << "arc,lo,hi,lo_node,hi_node,vertices,loop\n";
  for (std::size_t i = 0; i < graph.arc_count(); ++i) {
    out << i << ',' << vertex_of(graph, graph.lo[i]) << ',' << vertex_of(graph, graph.hi[i]) << ','
        << graph.lo[i].value() << ',' << graph.hi[i].value() << ',' << vertices_of(view, i) << ',';
    if (loops[i] != kNoLoop) out << Shortest{loops[i]};
    out << '\n';
  }
}

// The height of a node in the drawing is the rank of its value, since each line has just the length that it needs. An
// invisible line holds each component but the first at its height. With many components dot would take minutes, so then
// each has ranks and a place of its own.
void write_dot(const GraphView& view, OutputBuffer& out) {
  constexpr std::array kShapes = {"invtriangle", "house", "invhouse", "triangle", "diamond", "ellipse"};
  const ReebGraph& graph = view.graph;
  const GraphFeatures features = find_features(graph);
  constexpr std::uint32_t kMostHeld = 20;
  const auto last_component = std::ranges::max_element(features.component);
  const bool holds = last_component == features.component.end() || *last_component < kMostHeld;
  const std::vector<std::uint64_t> ranks =
      drawing_ranks(graph, holds ? std::vector<std::uint32_t>(graph.node_count(), 0) : features.component);
  out << "graph reeb {\n  rankdir=BT;\n  ranksep=0.2;\n  node [fontsize=10, height=0.2, margin=\"0.02,0.02\"];\n";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    const std::uint64_t vertex = graph.nodes[i].vertex.value();
    out << "  " << vertex << " [label=\"";
    append_rounded(out.text(), graph.nodes[i].value, 4);
    out << "\", shape=" << kShapes[static_cast<std::size_t>(features.type(i))] << ", tooltip=\"vertex " << vertex
        << "\"];\n";
  }
  const auto draw_line = [&](std::size_t lo, std::size_t hi, const char* style) {
    out << "  " << graph.nodes[lo].vertex.value() << " -- " << graph.nodes[hi].vertex.value()
        << " [minlen=" << ranks[hi] - ranks[lo] << style << "];\n";
  };
  for (std::size_t i = 0; i < graph.arc_count(); ++i) draw_line(graph.lo[i].value(), graph.hi[i].value(), "");
  std::uint32_t components = 1;
  for (std::size_t i = 0; holds && i < graph.node_count(); ++i)
    if (features.component[i] == components) {
      draw_line(0, i, ", style=invis");
      ++components;
    }
  out << "}\n";
}

void write_graphml(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const GraphFeatures features = find_features(graph);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n"
         "<key id=\"function\" for=\"graph\" attr.name=\"function\" attr.type=\"string\"/>\n";
  const auto declare = [&](const char* item, const char* name, const char* type) {
    out << "<key id=\"" << name << "\" for=\"" << item << "\" attr.name=\"" << name << "\" attr.type=\"" << type
        << "\"/>\n";
  };
  for (const char* name : {"value", "x", "y", "z", "persistence"}) declare("node", name, "double");
  for (const char* name : {"down", "up", "type", "component"}) declare("node", name, "long");
  for (const char* name : {"arc", "vertices"}) declare("edge", name, "long");
  declare("edge", "loop", "double");
  const auto write = [&](const char* name, auto value) {
    out << "<data key=\"" << name << "\">" << value << "</data>";
  };
  out << "<graph edgedefault=\"directed\">\n<data key=\"function\">";
  out << xml_escaped(view.function) << "</data>\n";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    out << "<node id=\"" << graph.nodes[i].vertex.value() << "\">";
    write("value", Shortest{graph.nodes[i].value});
    if (!graph.positions.empty()) {
      write("x", Shortest{graph.positions[i][0]});
      write("y", Shortest{graph.positions[i][1]});
      write("z", Shortest{graph.positions[i][2]});
    }
    write("down", features.degree.down[i]);
    write("up", features.degree.up[i]);
    write("type", number_of(features.type(i)));
    write("component", features.component[i]);
    write("persistence", Shortest{features.persistence[i]});
    out << "</node>\n";
  }
  for (std::size_t i = 0; i < graph.arc_count(); ++i) {
    out << "<edge id=\"" << i << "\" source=\"" << vertex_of(graph, graph.lo[i]) << "\" target=\""
        << vertex_of(graph, graph.hi[i]) << "\">";
    write("arc", i);
    write("vertices", vertices_of(view, i));
    if (features.loop[i] != kNoLoop) write("loop", Shortest{features.loop[i]});
    out << "</edge>\n";
  }
  out << "</graph>\n</graphml>\n";
}

}  // namespace reeb::io
