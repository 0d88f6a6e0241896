#include "io/plot/graph_picture.h"

#include <algorithm>

#include "io/drawing/canvas.h"
#include "io/plot/node_marks.h"
#include "io/plot/value_axis.h"
#include "io/text/number_text.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

constexpr double kWidth = 900, kHeight = 720;
constexpr double kLeft = 96, kRight = 24, kTop = kHeadingHeight + 18, kBottom = 52;

PicturePoint place(PicturePoint point) {
  return {kLeft + 14 + point.x * (kWidth - kLeft - kRight - 28),
          kHeight - kBottom - 8 - point.y * (kHeight - kTop - kBottom - 16)};
}

void append_axis(std::string& svg, const ReebGraph& graph, const std::string& function) {
  const double low = graph.nodes.front().value, high = graph.nodes.back().value;
  svg += "<g stroke=\"#dcdcdc\" stroke-width=\"0.7\">\n";
  std::string labels, title = "f = " + function;
  const std::vector<double> values = round_values(low, high, 8);
  const double base = axis_base(low, high, values);
  if (base != 0) title += ", less " + short_number(base, digits_for_range(low, high));
  for (const double value : values) {
    const double height = high > low ? (value / 2 - low / 2) / (high / 2 - low / 2) : 0.5;
    const double y = place({0, height}).y;
    svg += "<path d=\"M";
    append_point(svg, {kLeft - 5, y});
    svg += 'H';
    append_coordinate(svg, kWidth - kRight);
    svg += "\"/>\n";
    append_text(labels, {kLeft - 9, y + 4}, short_number(value - base), {.size = 12, .anchor = "end"});
  }
  svg += "</g>\n" + labels;
  svg += "<g transform=\"rotate(-90 22 ";
  append_coordinate(svg, kHeight / 2);
  svg += ")\">";
  append_text(svg, {22, kHeight / 2}, title, {.size = 13, .anchor = "middle"});
  svg += "</g>\n";
}

using Part = GraphLayout::Part;

void append_lines(std::string& svg, const ReebGraph& graph, const GraphLayout& layout,
                  std::span<const NodeKind> kinds) {
  const double crowd = static_cast<double>(kinds.size());
  const double width = crowd > 2000 ? 0.5 : (crowd > 300 ? 0.9 : 1.5);
  const double radius = crowd > 2000 ? 1.3 : (crowd > 300 ? 2.4 : 4.2);
  const double speck_radius = std::min(radius, 0.3 * (place({layout.speck_distance, 0}).x - place({0, 0}).x));
  svg += "<g fill=\"none\" stroke=\"#5a6b7b\" stroke-width=\"";
  append_coordinate(svg, width);
  svg += "\">\n";
  for (std::size_t arc = 0; arc < layout.arcs.size(); ++arc) {
    const auto& curve = layout.arcs[arc];
    if (layout.parts[graph.lo[arc].value()] == Part::kLeftOut) continue;
    svg += "<path class=\"arc\" d=\"M";
    append_point(svg, place(curve.front()));
    for (std::size_t i = 1; i < curve.size(); ++i) {
      svg += i == 1 ? 'C' : ' ';
      append_point(svg, place(curve[i]));
    }
    svg += "\"/>\n";
  }
  svg += "</g>\n<g stroke=\"#222\" stroke-width=\"";
  append_coordinate(svg, std::min(1.0, radius / 3), 2);
  svg += "\">\n";
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (layout.parts[i] != Part::kLeftOut)
      append_node(svg, place(layout.nodes[i]), kinds[i], layout.parts[i] == Part::kSpeck ? speck_radius : radius);
  svg += "</g>\n";
}

PicturePoint on_curve(std::span<const PicturePoint> controls, double t) {
  const double s = 1 - t, a = s * s * s, b = 3 * s * s * t, c = 3 * s * t * t, d = t * t * t;
  return {a * controls[0].x + b * controls[1].x + c * controls[2].x + d * controls[3].x,
          a * controls[0].y + b * controls[1].y + c * controls[2].y + d * controls[3].y};
}

void append_raster(std::string& svg, const ReebGraph& graph, const GraphLayout& layout,
                   std::span<const NodeKind> kinds) {
  constexpr double kScale = 2;
  const PicturePoint corner{kLeft, kTop - 8};
  const double width = kWidth - kLeft - kRight, height = kHeight - kTop - kBottom + 16;
  Canvas canvas(width, height, kScale);
  const auto inside = [&](PicturePoint point) {
    const PicturePoint at = place(point);
    return PicturePoint{at.x - corner.x, at.y - corner.y};
  };
  for (std::size_t arc = 0; arc < layout.arcs.size(); ++arc) {
    const auto& curve = layout.arcs[arc];
    if (layout.parts[graph.lo[arc].value()] == Part::kLeftOut) continue;
    for (std::size_t i = 0; i + 3 < curve.size(); i += 3) {
      constexpr int kPieces = 12;
      const auto controls = std::span(curve).subspan(i, 4);
      PicturePoint last = inside(controls[0]);
      for (int k = 1; k <= kPieces; ++k) {
        const PicturePoint next = inside(on_curve(controls, static_cast<double>(k) / kPieces));
        canvas.line(last, next, 0.35, {126, 141, 156});
        last = next;
      }
    }
  }
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] != NodeKind::kFork && layout.parts[i] != Part::kLeftOut)
      canvas.disc(inside(layout.nodes[i]), 0.7, node_color(kinds[i]));
  append_image(svg, canvas.image(), corner, width, height);
}

}  // namespace

std::string graph_picture(const ReebGraph& graph, const GraphLayout& layout, const std::string& function,
                          const Heading& heading) {
  const std::vector<NodeKind> kinds = node_kinds(graph);
  Heading complete = heading;
  if (layout.left_out > 0)
    complete.subtitle += "; " + with_commas(layout.left_out) + " of the components of one node or arc are not drawn";
  const bool as_lines = graph.arc_count() <= kMostArcsAsLines && graph.node_count() <= 2 * kMostArcsAsLines;
  std::string svg = begin_svg(kWidth, kHeight, complete);
  std::string axis;
  append_axis(axis, graph, function);
  if (!as_lines) append_raster(svg, graph, layout, kinds);  // it covers the grid
  svg += axis;
  if (as_lines) append_lines(svg, graph, layout, kinds);
  append_legend(svg, {kLeft + 14, kHeight - 16}, kinds);
  if (!as_lines)
    append_text(svg, {kWidth - kRight, kHeight - 12}, "Minima and maxima are dots; forks are not marked.",
                {.size = 11, .anchor = "end", .color = kGreyInk});
  return svg + "</svg>\n";
}

}  // namespace reeb::io
