#include "io/export/graph_export.h"

#include <array>
#include <utility>

#include "io/export/graph_lines.h"
#include "io/export/graph_texts.h"
#include "io/export/swc_samples.h"
#include "io/text/output_buffer.h"

namespace reeb::io {
namespace {

constexpr std::array<std::pair<std::string_view, GraphFormat>, 11> kFormats = {{
    {"rg", GraphFormat::kRg},
    {"json", GraphFormat::kJson},
    {"csv", GraphFormat::kCsv},
    {"dot", GraphFormat::kDot},
    {"graphml", GraphFormat::kGraphml},
    {"vtp", GraphFormat::kVtp},
    {"vtu", GraphFormat::kVtu},
    {"ply", GraphFormat::kPly},
    {"obj", GraphFormat::kObj},
    {"swc", GraphFormat::kSwc},
    {"gltf", GraphFormat::kGltf},
}};

}  // namespace

bool has_lines(GraphFormat format) {
  switch (format) {
    case GraphFormat::kVtp:
    case GraphFormat::kVtu:
    case GraphFormat::kPly:
    case GraphFormat::kObj:
    case GraphFormat::kSwc:
    case GraphFormat::kGltf:
      return true;
    default:
      return false;
  }
}

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
      write_node_table(view, out);
      out << '\n';
      write_arc_table(view, out);
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
    case GraphFormat::kSwc:
      write_swc(view, out);
      break;
    case GraphFormat::kGltf:
      write_gltf_lines(view, out);
      break;
  }
  out.flush();
}

void write_csv_tables(const GraphView& view, std::ostream& nodes, std::ostream& arcs) {
  OutputBuffer node_table(nodes), arc_table(arcs);
  write_node_table(view, node_table);
  node_table.flush();
  write_arc_table(view, arc_table);
  arc_table.flush();
}

}  // namespace reeb::io
