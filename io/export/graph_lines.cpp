#include "io/export/graph_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "io/export/graph_features.h"
#include "io/export/line_points.h"
#include "libreeb/base/error.h"
#include "libreeb/graph/loop_ranges.h"

namespace reeb::io {
namespace {

void write_point(const std::array<double, 3>& point, OutputBuffer& out) {
  out << Shortest{point[0]} << ' ' << Shortest{point[1]} << ' ' << Shortest{point[2]} << '\n';
}

void begin_array(const char* type, const char* name, OutputBuffer& out) {
  out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
}

// The middle of the values that the arc has in this bucket.
double value_of(const GraphView& view, std::size_t arc, const Bucket& bucket) {
  const double lo = view.graph.nodes[view.graph.lo[arc].value()].value;
  const double hi = view.graph.nodes[view.graph.hi[arc].value()].value;
  const auto index = static_cast<double>(bucket.index);
  const double bottom = std::max(lo, std::ldexp(index, view.bucket_exponent));
  const double top = std::min(hi, std::ldexp(index + 1, view.bucket_exponent));
  return bottom + (top - bottom) / 2;
}

// Calls of_node(node) for each node, then of_arc(arc) for each point between the nodes of each arc.
template <class OfNode, class OfArc>
void write_point_array(const GraphView& view, const char* type, const char* name, const OfNode& of_node,
                       const OfArc& of_arc, OutputBuffer& out) {
  begin_array(type, name, out);
  for (std::size_t node = 0; node < view.graph.node_count(); ++node) out << of_node(node) << '\n';
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc)
    for_each_inner_point(view, arc, [&](const Bucket& bucket) { out << of_arc(arc, bucket) << '\n'; });
  out << "</DataArray>\n";
}

void write_vtk_point_data(const GraphView& view, const GraphFeatures& features, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const auto always = [](auto value) { return [value](std::size_t, const Bucket&) { return value; }; };
  out << "<PointData Scalars=\"Value\">\n";
  write_point_array(
      view, "Float64", "Value", [&](std::size_t node) { return Shortest{graph.nodes[node].value}; },
      [&](std::size_t arc, const Bucket& bucket) { return Shortest{value_of(view, arc, bucket)}; }, out);
  write_point_array(
      view, "Int64", "VertexId", [&](std::size_t node) { return graph.nodes[node].vertex.value(); }, always(-1), out);
  write_point_array(
      view, "Int32", "CriticalType", [&](std::size_t node) { return static_cast<int>(features.type(node)); },
      always(static_cast<int>(CriticalType::kRegular)), out);
  write_point_array(
      view, "Int64", "NodeId", [](std::size_t node) { return node; }, always(-1), out);
  write_point_array(
      view, "Int32", "DownDegree", [&](std::size_t node) { return features.degree.down[node]; }, always(1), out);
  write_point_array(
      view, "Int32", "UpDegree", [&](std::size_t node) { return features.degree.up[node]; }, always(1), out);
  write_point_array(
      view, "Int32", "Component", [&](std::size_t node) { return features.component[node]; },
      [&](std::size_t arc, const Bucket&) { return features.component[graph.lo[arc].value()]; }, out);
  // VTK reads no infinity in text.
  constexpr double kMost = std::numeric_limits<double>::max();
  write_point_array(
      view, "Float64", "Persistence",
      [&](std::size_t node) { return Shortest{std::min(features.persistence[node], kMost)}; }, always(0), out);
  if (view.has_spreads) {
    begin_array("Float64", "Radius", out);
    for (const double radius : all_radii(view)) out << Shortest{radius} << '\n';
    out << "</DataArray>\n";
  }
  out << "</PointData>\n";
}

// The nodes without arcs.
std::vector<std::size_t> isolated_nodes(const GraphFeatures& features) {
  std::vector<std::size_t> isolated;
  for (std::size_t node = 0; node < features.component.size(); ++node)
    if (features.degree.down[node] + features.degree.up[node] == 0) isolated.push_back(node);
  return isolated;
}

// Of isolated nodes there is nothing to measure. VTK reads no NaN in text: what is not known is -1.
void write_vtk_measures(const GraphView& view, std::span<const std::size_t> isolated, OutputBuffer& out) {
  if (view.measures.empty()) return;
  const auto write_array = [&](const char* type, const char* name, const auto& of_node, const auto& of_arc) {
    begin_array(type, name, out);
    for (const std::size_t node : isolated) out << of_node(node) << '\n';
    for (const ArcMeasures& arc : view.measures) out << of_arc(arc) << '\n';
    out << "</DataArray>\n";
  };
  const auto zero = [](std::size_t) { return 0; };
  const auto known = [](double value) { return Shortest{std::isnan(value) ? -1 : value}; };
  write_array("Int64", "SegmentVertices", zero, [](const ArcMeasures& arc) { return arc.vertices; });
  write_array(
      "Float64", "Mean", [&](std::size_t node) { return Shortest{view.graph.nodes[node].value}; },
      [](const ArcMeasures& arc) { return Shortest{arc.mean}; });
  write_array("Float64", "Area", zero, [&](const ArcMeasures& arc) { return known(arc.area); });
  write_array("Float64", "ShortestContour", zero, [&](const ArcMeasures& arc) { return known(arc.shortest_contour); });
}

// Cells are the isolated nodes, then the arcs.
void write_vtk_cell_data(const GraphView& view, const GraphFeatures& features, std::span<const std::size_t> isolated,
                         OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  const auto write_array = [&](const char* type, const char* name, const auto& of_node, const auto& of_arc) {
    begin_array(type, name, out);
    for (const std::size_t node : isolated) out << of_node(node) << '\n';
    for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) out << of_arc(arc) << '\n';
    out << "</DataArray>\n";
  };
  const auto itself = [](std::size_t i) { return i; };
  const auto always = [](auto value) { return [value](std::size_t) { return value; }; };
  out << "<CellData Scalars=\"SegmentationId\">\n";
  write_array("Int64", "SegmentationId", always(-1), itself);
  write_array("Int64", "upNodeId", itself, [&](std::size_t arc) { return graph.hi[arc].value(); });
  write_array("Int64", "downNodeId", itself, [&](std::size_t arc) { return graph.lo[arc].value(); });
  write_array("Int64", "VertexCount", always(0), [&](std::size_t arc) {
    std::uint64_t vertices = 0;
    for_each_inner_point(view, arc, [&](const Bucket& bucket) { vertices += bucket.count; });
    return vertices;
  });
  write_array("Float64", "LoopPersistence", always(Shortest{kNoLoop}),
              [&](std::size_t arc) { return Shortest{features.loop[arc]}; });
  write_vtk_measures(view, isolated, out);
  out << "</CellData>\n";
}

void write_vtk_cells(const GraphView& view, VtkKind kind, std::span<const std::size_t> isolated, OutputBuffer& out) {
  const auto nothing = [](auto...) {};
  const bool in_one = kind == VtkKind::kUnstructuredGrid;
  const auto begin_points = [&] {
    begin_array("Int64", "connectivity", out);
    for (const std::size_t node : isolated) out << node << '\n';
  };
  std::uint64_t offset = 0;
  const auto end_points = [&] {
    out << "</DataArray>\n";
    begin_array("Int64", "offsets", out);
    for (std::size_t i = 0; i < isolated.size(); ++i) out << ++offset << '\n';
  };
  if (in_one) {
    out << "<Cells>\n";
    begin_points();
  } else {
    out << "<Verts>\n";
    begin_points();
    end_points();
    out << "</DataArray>\n</Verts>\n<Lines>\n";
    begin_array("Int64", "connectivity", out);
    offset = 0;
  }
  for_each_line(
      view, nothing, [&](std::uint64_t i) { out << i << ' '; }, [&] { out << '\n'; });
  if (in_one) {
    end_points();
  } else {
    out << "</DataArray>\n";
    begin_array("Int64", "offsets", out);
  }
  for_each_line(
      view, [&](std::uint64_t points) { out << (offset += points) << '\n'; }, nothing, nothing);
  out << "</DataArray>\n";
  if (in_one) {
    begin_array("UInt8", "types", out);
    for (std::size_t i = 0; i < isolated.size(); ++i) out << "1\n";  // VTK_VERTEX
    for_each_line(
        view, [&](std::uint64_t) { out << "4\n"; }, nothing, nothing);  // VTK_POLY_LINE
    out << "</DataArray>\n";
  }
  out << (in_one ? "</Cells>\n" : "</Lines>\n");
}

}  // namespace

void write_vtk_lines(const GraphView& view, VtkKind kind, OutputBuffer& out) {
  const GraphFeatures features = find_features(view.graph);
  const std::vector<std::size_t> isolated = isolated_nodes(features);
  const char* type = kind == VtkKind::kPolyData ? "PolyData" : "UnstructuredGrid";
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type
      << "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" << type
      << ">\n<Piece NumberOfPoints=\"" << all_points(view) << '"';
  if (kind == VtkKind::kPolyData)
    out << " NumberOfVerts=\"" << isolated.size() << "\" NumberOfLines=\"" << view.graph.arc_count() << "\">\n";
  else
    out << " NumberOfCells=\"" << isolated.size() + view.graph.arc_count() << "\">\n";
  write_vtk_point_data(view, features, out);
  write_vtk_cell_data(view, features, isolated, out);
  out << "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for_each_point(view, [&](const auto& point) { write_point(point, out); });
  out << "</DataArray>\n</Points>\n";
  write_vtk_cells(view, kind, isolated, out);
  out << "</Piece>\n</" << type << ">\n</VTKFile>\n";
}

void require_few_points(std::uint64_t points, std::uint64_t most, const char* format) {
  if (points > most)
    throw Error(ErrorKind::kBadInput,
                std::string("the graph has ") + std::to_string(points) + " points, but " + format +
                    " numbers at most " + std::to_string(most),
                "write it as vtp, or choose a coarser level");
}

void write_ply_lines(const GraphView& view, OutputBuffer& out) {
  const std::uint64_t points = all_points(view);
  require_few_points(points, kMostPlyPoints, "PLY");
  std::uint64_t edges = 0;
  for_each_segment(view, [&](std::uint64_t, std::uint64_t) { ++edges; });
  out << "ply\nformat ascii 1.0\nelement vertex " << points
      << "\nproperty double x\nproperty double y\nproperty double z\nelement edge " << edges
      << "\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  for_each_point(view, [&](const auto& point) { write_point(point, out); });
  for_each_segment(view, [&](std::uint64_t a, std::uint64_t b) { out << a << ' ' << b << '\n'; });
}

void write_obj_lines(const GraphView& view, OutputBuffer& out) {
  for_each_point(view, [&](const auto& point) {
    out << "v ";
    write_point(point, out);
  });
  for_each_line(
      view, [&](std::uint64_t) { out << 'l'; }, [&](std::uint64_t i) { out << ' ' << i + 1; }, [&] { out << '\n'; });
  for (const std::size_t node : isolated_nodes(find_features(view.graph))) out << "p " << node + 1 << '\n';
}

}  // namespace reeb::io
