#include "io/export/graph_export.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "io/export/graph_lines.h"
#include "io/text/output_buffer.h"

namespace reeb::io {
namespace {

constexpr std::array<std::pair<std::string_view, GraphFormat>, 9> kFormats = {{
    {"rg", GraphFormat::kRg},
    {"json", GraphFormat::kJson},
    {"csv", GraphFormat::kCsv},
    {"dot", GraphFormat::kDot},
    {"graphml", GraphFormat::kGraphml},
    {"vtp", GraphFormat::kVtp},
    {"vtu", GraphFormat::kVtu},
    {"ply", GraphFormat::kPly},
    {"obj", GraphFormat::kObj},
}};

std::uint64_t vertex_of(const ReebGraph& graph, NodeId node) { return graph.nodes[node.value()].vertex.value(); }

std::uint64_t vertices_of(const GraphView& view, std::size_t arc) {
  std::uint64_t sum = 0;
  if (!view.buckets.empty())
    for (const Bucket& bucket : view.buckets.of(arc)) sum += bucket.count;
  return sum;
}

// A JSON string literal: control characters, quotes and backslashes are escaped, UTF-8 is unchanged.
void write_json_string(std::string_view text, OutputBuffer& out) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out << '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out << '\\' << c;
    else if (byte < 0x20)
      out << "\\u00" << kHex[byte >> 4] << kHex[byte & 15];
    else
      out << c;
  }
  out << '"';
}

// JSON has no infinities.
void write_json_number(double value, OutputBuffer& out) {
  if (std::isfinite(value))
    out << value;
  else
    out << "null";
}

void write_xml_text(std::string_view text, OutputBuffer& out) {
  for (const char c : text) {
    if (c == '&')
      out << "&amp;";
    else if (c == '<')
      out << "&lt;";
    else if (c == '>')
      out << "&gt;";
    else if (c == '"')
      out << "&quot;";
    else
      out << c;
  }
}

void write_rg(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const Degrees degree = degrees(graph);
  for (std::size_t i = 0; i < graph.node_count(); ++i)
    out << "n " << graph.nodes[i].vertex.value() << ' ' << degree.down[i] << ' ' << degree.up[i] << ' '
        << graph.nodes[i].value << '\n';
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    out << "a " << vertex_of(graph, graph.lo[i]) << ' ' << vertex_of(graph, graph.hi[i]) << '\n';
}

void write_json_measures(const ArcMeasures& arc, OutputBuffer& out) {
  out << ", \"segment_vertices\": " << arc.vertices << ", \"mean\": ";
  write_json_number(arc.mean, out);
  out << ", \"area\": ";
  write_json_number(arc.area, out);
  out << ", \"shortest_contour\": ";
  write_json_number(arc.shortest_contour, out);
}

void write_json(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const Degrees degree = degrees(graph);
  out << "{\"schema\": \"reeb.graph.v1\", \"function\": ";
  write_json_string(view.function, out);
  out << ", \"threshold\": ";
  write_json_number(view.threshold, out);
  out << ",\n\"nodes\": [";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    out << (i == 0 ? "\n" : ",\n") << "{\"vertex\": " << graph.nodes[i].vertex.value()
        << ", \"value\": " << graph.nodes[i].value << ", \"position\": ";
    if (graph.positions.empty())
      out << "null";
    else
      out << '[' << graph.positions[i][0] << ", " << graph.positions[i][1] << ", " << graph.positions[i][2] << ']';
    out << ", \"down\": " << degree.down[i] << ", \"up\": " << degree.up[i] << '}';
  }
  out << "],\n\"arcs\": [";
  for (std::size_t i = 0; i < graph.arc_count(); ++i) {
    out << (i == 0 ? "\n" : ",\n") << "{\"lo\": " << vertex_of(graph, graph.lo[i])
        << ", \"hi\": " << vertex_of(graph, graph.hi[i]) << ", \"vertices\": " << vertices_of(view, i);
    if (!view.measures.empty()) write_json_measures(view.measures[i], out);
    out << ", \"path\": [";
    bool first = true;
    if (!view.buckets.empty())
      for (const Bucket& bucket : view.buckets.of(i)) {
        if (bucket.count == 0) continue;
        out << (std::exchange(first, false) ? "" : ", ") << '[' << bucket.mean[0] << ", " << bucket.mean[1] << ", "
            << bucket.mean[2] << ", " << bucket.count << ']';
      }
    out << "]}";
  }
  out << "]}\n";
}

void write_csv(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const Degrees degree = degrees(graph);
  out << "item,vertex,down,up,value,x,y,z,lo,hi,vertices\n";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    out << "node," << graph.nodes[i].vertex.value() << ',' << degree.down[i] << ',' << degree.up[i] << ','
        << graph.nodes[i].value << ',';
    if (graph.positions.empty())
      out << ",,";
    else
      out << graph.positions[i][0] << ',' << graph.positions[i][1] << ',' << graph.positions[i][2];
    out << ",,,\n";
  }
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    out << "arc,,,,,,,," << vertex_of(graph, graph.lo[i]) << ',' << vertex_of(graph, graph.hi[i]) << ','
        << vertices_of(view, i) << '\n';
}

void write_dot(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  out << "graph reeb {\n  rankdir=BT;\n";
  for (const SweepKey& node : graph.nodes)
    out << "  " << node.vertex.value() << " [label=\"" << node.vertex.value() << "\\n" << node.value << "\"];\n";
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    out << "  " << vertex_of(graph, graph.lo[i]) << " -- " << vertex_of(graph, graph.hi[i]) << ";\n";
  out << "}\n";
}

void write_graphml(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n"
         "<key id=\"function\" for=\"graph\" attr.name=\"function\" attr.type=\"string\"/>\n"
         "<key id=\"value\" for=\"node\" attr.name=\"value\" attr.type=\"double\"/>\n"
         "<key id=\"x\" for=\"node\" attr.name=\"x\" attr.type=\"double\"/>\n"
         "<key id=\"y\" for=\"node\" attr.name=\"y\" attr.type=\"double\"/>\n"
         "<key id=\"z\" for=\"node\" attr.name=\"z\" attr.type=\"double\"/>\n"
         "<graph edgedefault=\"directed\">\n<data key=\"function\">";
  write_xml_text(view.function, out);
  out << "</data>\n";
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    out << "<node id=\"" << graph.nodes[i].vertex.value() << "\"><data key=\"value\">" << graph.nodes[i].value
        << "</data>";
    if (!graph.positions.empty())
      for (std::size_t axis = 0; axis < 3; ++axis)
        out << "<data key=\""
            << "xyz"[axis] << "\">" << graph.positions[i][axis] << "</data>";
    out << "</node>\n";
  }
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    out << "<edge source=\"" << vertex_of(graph, graph.lo[i]) << "\" target=\"" << vertex_of(graph, graph.hi[i])
        << "\"/>\n";
  out << "</graph>\n</graphml>\n";
}

}  // namespace

std::optional<GraphFormat> graph_format(std::string_view name) {
  for (const auto& [known, format] : kFormats)
    if (known == name) return format;
  return std::nullopt;
}

std::string graph_format_names() {
  std::string names;
  for (const auto& [name, format] : kFormats) {
    if (!names.empty()) names += ' ';
    names += name;
  }
  return names;
}

void write_graph(GraphFormat format, const GraphView& view, std::ostream& stream) {
  OutputBuffer out(stream);
  switch (format) {
    case GraphFormat::kRg:
      write_rg(view, out);
      break;
    case GraphFormat::kJson:
      write_json(view, out);
      break;
    case GraphFormat::kCsv:
      write_csv(view, out);
      break;
    case GraphFormat::kDot:
      write_dot(view, out);
      break;
    case GraphFormat::kGraphml:
      write_graphml(view, out);
      break;
    case GraphFormat::kVtp:
      write_vtk_lines(view, VtkKind::kPolyData, out);
      break;
    case GraphFormat::kVtu:
      write_vtk_lines(view, VtkKind::kUnstructuredGrid, out);
      break;
    case GraphFormat::kPly:
      write_ply_lines(view, out);
      break;
    case GraphFormat::kObj:
      write_obj_lines(view, out);
      break;
  }
  out.flush();
}

}  // namespace reeb::io
