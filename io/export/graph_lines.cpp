#include "io/export/graph_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/export/arc_line.h"

namespace reeb::io {
namespace {

std::array<double, 3> node_position(const ReebGraph& graph, std::size_t node) {
  if (graph.positions.empty()) return {0, 0, graph.nodes[node].value};
  return graph.positions[node];
}

// Calls visit(bucket) for the points along an arc.
template <class Visit>
void for_each_inner_point(const GraphView& view, std::size_t arc, const Visit& visit) {
  if (view.buckets.empty()) return;
  for (const Bucket& bucket : view.buckets.of(arc))
    if (bucket.count != 0) visit(bucket);
}

std::uint64_t inner_points(const GraphView& view, std::size_t arc) {
  std::uint64_t count = 0;
  for_each_inner_point(view, arc, [&](const Bucket&) { ++count; });
  return count;
}

std::uint64_t all_points(const GraphView& view) {
  std::uint64_t count = view.graph.node_count();
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) count += inner_points(view, arc);
  return count;
}

template <class Visit>
void for_each_point(const GraphView& view, const Visit& visit) {
  for (std::size_t i = 0; i < view.graph.node_count(); ++i) visit(node_position(view.graph, i));
  if (view.buckets.empty()) return;
  std::vector<std::array<double, 3>> line;
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) {
    draw_arc(node_position(view.graph, view.graph.lo[arc].value()), view.buckets.of(arc),
             node_position(view.graph, view.graph.hi[arc].value()), line);
    for (const auto& point : line) visit(point);
  }
}

// Calls begin(points), point(index) for each, end(), for each arc.
template <class Begin, class At, class End>
void for_each_line(const GraphView& view, const Begin& begin, const At& at, const End& end) {
  std::uint64_t next = view.graph.node_count();
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) {
    const std::uint64_t inner = inner_points(view, arc);
    begin(inner + 2);
    at(view.graph.lo[arc].value());
    for (std::uint64_t i = 0; i < inner; ++i) at(next++);
    at(view.graph.hi[arc].value());
    end();
  }
}

void write_point(const std::array<double, 3>& point, OutputBuffer& out) {
  out << point[0] << ' ' << point[1] << ' ' << point[2] << '\n';
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

// Nodes have their value and vertex; points along arcs have the vertex -1.
void write_vtk_point_data(const GraphView& view, OutputBuffer& out) {
  const ReebGraph& graph = view.graph;
  out << "<PointData Scalars=\"value\">\n";
  begin_array("Float64", "value", out);
  for (const SweepKey& node : graph.nodes) out << node.value << '\n';
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
    for_each_inner_point(view, arc, [&](const Bucket& bucket) { out << value_of(view, arc, bucket) << '\n'; });
  out << "</DataArray>\n";
  begin_array("Int64", "vertex", out);
  for (const SweepKey& node : graph.nodes) out << node.vertex.value() << '\n';
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
    for_each_inner_point(view, arc, [&](const Bucket&) { out << "-1\n"; });
  out << "</DataArray>\n</PointData>\n";
}

// VTK reads no NaN in text: what is not known is -1.
void write_vtk_measures(const GraphView& view, OutputBuffer& out) {
  if (view.measures.empty()) return;
  const auto known = [](double value) { return std::isnan(value) ? -1 : value; };
  out << "<CellData>\n";
  begin_array("Int64", "SegmentVertices", out);
  for (const ArcMeasures& arc : view.measures) out << arc.vertices << '\n';
  out << "</DataArray>\n";
  begin_array("Float64", "Mean", out);
  for (const ArcMeasures& arc : view.measures) out << arc.mean << '\n';
  out << "</DataArray>\n";
  begin_array("Float64", "Area", out);
  for (const ArcMeasures& arc : view.measures) out << known(arc.area) << '\n';
  out << "</DataArray>\n";
  begin_array("Float64", "ShortestContour", out);
  for (const ArcMeasures& arc : view.measures) out << known(arc.shortest_contour) << '\n';
  out << "</DataArray>\n</CellData>\n";
}

void write_vtk_cells(const GraphView& view, VtkKind kind, OutputBuffer& out) {
  const char* element = kind == VtkKind::kPolyData ? "Lines" : "Cells";
  const auto nothing = [](auto...) {};
  out << '<' << element << ">\n";
  begin_array("Int64", "connectivity", out);
  for_each_line(
      view, nothing, [&](std::uint64_t i) { out << i << ' '; }, [&] { out << '\n'; });
  out << "</DataArray>\n";
  begin_array("Int64", "offsets", out);
  std::uint64_t offset = 0;
  for_each_line(
      view, [&](std::uint64_t points) { out << (offset += points) << '\n'; }, nothing, nothing);
  out << "</DataArray>\n";
  if (kind == VtkKind::kUnstructuredGrid) {
    begin_array("UInt8", "types", out);
    for_each_line(
        view, [&](std::uint64_t) { out << "4\n"; }, nothing, nothing);  // VTK_POLY_LINE
    out << "</DataArray>\n";
  }
  out << "</" << element << ">\n";
}

}  // namespace

void write_vtk_lines(const GraphView& view, VtkKind kind, OutputBuffer& out) {
  const char* type = kind == VtkKind::kPolyData ? "PolyData" : "UnstructuredGrid";
  const char* cells = kind == VtkKind::kPolyData ? "NumberOfLines" : "NumberOfCells";
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type << "\" version=\"0.1\" byte_order=\"LittleEndian\">\n<"
      << type << ">\n<Piece NumberOfPoints=\"" << all_points(view) << "\" " << cells << "=\"" << view.graph.arc_count()
      << "\">\n";
  write_vtk_point_data(view, out);
  write_vtk_measures(view, out);
  out << "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for_each_point(view, [&](const auto& point) { write_point(point, out); });
  out << "</DataArray>\n</Points>\n";
  write_vtk_cells(view, kind, out);
  out << "</Piece>\n</" << type << ">\n</VTKFile>\n";
}

void write_ply_lines(const GraphView& view, OutputBuffer& out) {
  std::uint64_t edges = 0;
  for_each_line(
      view, [&](std::uint64_t points) { edges += points - 1; }, [](std::uint64_t) {}, [] {});
  out << "ply\nformat ascii 1.0\nelement vertex " << all_points(view)
      << "\nproperty double x\nproperty double y\nproperty double z\nelement edge " << edges
      << "\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  for_each_point(view, [&](const auto& point) { write_point(point, out); });
  std::uint64_t before = 0;
  bool first = true;
  for_each_line(
      view, [&](std::uint64_t) { first = true; },
      [&](std::uint64_t i) {
        if (!first) out << before << ' ' << i << '\n';
        first = false;
        before = i;
      },
      [] {});
}

void write_obj_lines(const GraphView& view, OutputBuffer& out) {
  for_each_point(view, [&](const auto& point) {
    out << "v ";
    write_point(point, out);
  });
  for_each_line(
      view, [&](std::uint64_t) { out << 'l'; }, [&](std::uint64_t i) { out << ' ' << i + 1; }, [&] { out << '\n'; });
}

}  // namespace reeb::io
